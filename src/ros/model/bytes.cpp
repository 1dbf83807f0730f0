#include "bytes.h"

#include "../text.h"

namespace self_awareness::ros1 {
namespace {

constexpr char kTooShort[] = "it ends too soon, or a length in it is wrong";

}  // namespace

std::size_t ByteReader::length(std::size_t each) {
  const std::uint64_t number = readNumber();
  check(number <= static_cast<std::size_t>(end_ - next_), kTooShort);
  memory_ += number * each;
  check(memory_ <= most_, "there is too much in it");
  return number;
}

void ByteReader::read(std::string& text) {
  text.resize(length(1));
  take(text.data(), text.size());
  check(text.size() <= kLongestText && isPrintable(text),
        "a text in it is no UTF-8, has control characters, or is too long");
}

std::uint64_t ByteReader::readNumber() {
  std::uint64_t number = 0;
  for (unsigned shift = 0;; shift += 7) {
    check(next_ != end_, kTooShort);
    const std::uint64_t bits = *next_ % 128U;
    check(shift < 64 && bits << shift >> shift == bits, "a number in it cannot be");
    number |= bits << shift;
    if (*next_++ < 128) {
      return number;
    }
  }
}

void ByteReader::take(void* data, std::size_t size) {
  check(size <= static_cast<std::size_t>(end_ - next_), kTooShort);
  if (size > 0) {
    std::memcpy(data, next_, size);
    next_ += size;
  }
}

}  // namespace self_awareness::ros1
