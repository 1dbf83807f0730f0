#pragma once

#include <cstddef>
#include <cstdint>

namespace self_awareness::ros1 {

/// A number over messages in a row, which is another one if any bit of them, their number or their
/// order is. It finds damage; who changes a file on purpose can write a new one.
class ContentDigest {
 public:
  /// Adds a message, as it lies in the file.
  void add(const std::uint8_t* data, std::size_t size);

  std::uint64_t value() const { return value_; }

 private:
  void mix(std::uint64_t number);

  std::uint64_t value_ = 0xcbf29ce484222325;  // of no message
};

}  // namespace self_awareness::ros1
