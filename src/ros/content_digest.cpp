#include "content_digest.h"

#include <algorithm>
#include <cstring>

namespace self_awareness::ros1 {

// FNV-1a, by numbers instead of bytes: eight times as fast. The shift brings the upper bits, which
// its multiplication never moves down, to the others.
void ContentDigest::mix(std::uint64_t number) {
  value_ = (value_ ^ number) * 0x100000001b3;
  value_ ^= value_ >> 29U;
}

void ContentDigest::add(const std::uint8_t* data, std::size_t size) {
  mix(size);
  for (std::size_t at = 0; at < size; at += sizeof(std::uint64_t)) {
    std::uint64_t number = 0;
    std::memcpy(&number, data + at, std::min(sizeof number, size - at));
    mix(number);
  }
}

}  // namespace self_awareness::ros1
