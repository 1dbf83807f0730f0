#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "../check.h"
#include "../text.h"

namespace self_awareness::ros1 {

// Values as bytes, one after the other (docs/monitor.md). Whole numbers take seven bits a byte,
// the lowest first; of signed ones, the lowest bit is the sign. Other numbers are as in the
// memory; texts and lists follow their length. A struct is what its function fields() passes, the
// same one for both directions.

/// Writes values.
class ByteWriter {
 public:
  template <typename... Values>
  void operator()(const Values&... values) {
    (add(values), ...);
  }
  /// Whether the bytes hold what a format added: as this version writes them, they do.
  static bool has(std::uint32_t /*format*/) { return true; }
  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  template <typename Value>
  void add(const Value& value) {
    if constexpr (std::is_enum_v<Value>) {
      add(static_cast<std::underlying_type_t<Value>>(value));
    } else if constexpr (std::is_unsigned_v<Value>) {
      addNumber(value);
    } else if constexpr (std::is_integral_v<Value>) {
      const auto wide = static_cast<std::int64_t>(value);
      addNumber(static_cast<std::uint64_t>(wide) << 1U ^ static_cast<std::uint64_t>(wide >> 63U));
    } else if constexpr (std::is_floating_point_v<Value>) {
      append(&value, sizeof value);
    } else {
      fields(*this, value);
    }
  }
  void add(const std::string& text) {
    addNumber(text.size());
    append(text.data(), text.size());
  }
  void add(const std::vector<std::uint8_t>& bytes) {
    addNumber(bytes.size());
    append(bytes.data(), bytes.size());
  }
  template <typename Value>
  void add(const std::vector<Value>& list) {
    addAll(list);
  }
  template <typename Value>
  void add(const std::set<Value>& set) {
    addAll(set);
  }
  template <typename Key, typename Value>
  void add(const std::map<Key, Value>& map) {
    addAll(map);
  }
  template <typename First, typename Second>
  void add(const std::pair<First, Second>& pair) {
    (*this)(pair.first, pair.second);
  }
  template <typename Value, std::size_t kNumber>
  void add(const std::array<Value, kNumber>& array) {
    for (const Value& each : array) {
      add(each);
    }
  }
  template <typename Value>
  void add(const std::optional<Value>& value) {
    add(value.has_value());
    if (value) {
      add(*value);
    }
  }
  template <typename List>
  void addAll(const List& list) {
    addNumber(list.size());
    for (const auto& each : list) {
      add(each);
    }
  }
  void addNumber(std::uint64_t number) {
    for (; number >= 128; number >>= 7U) {
      bytes_.push_back(static_cast<std::uint8_t>(number | 128U));
    }
    bytes_.push_back(static_cast<std::uint8_t>(number));
  }
  void append(const void* data, std::size_t size) {
    const auto* begin = static_cast<const std::uint8_t*>(data);
    bytes_.insert(bytes_.end(), begin, begin + size);
  }

  std::vector<std::uint8_t> bytes_;
};

/// Reads them again, of a stranger: nothing is believed before it is checked, and lengths that lie
/// ask for no memory. Each function throws std::invalid_argument, which says what is wrong.
class ByteReader {
 public:
  /// What a stranger's bytes may ask for [bytes].
  static constexpr std::size_t kMostMemory = std::size_t{1} << 30U;

  /// @param format that the bytes are of
  /// @param most memory that all that is read may take [bytes]
  ByteReader(const std::uint8_t* data, std::size_t size, std::uint32_t format,
             std::size_t most = kMostMemory)
      : next_(data), end_(data + size), format_(format), most_(most) {}

  template <typename... Values>
  void operator()(Values&... values) {
    (read(values), ...);
  }
  /// Whether the bytes hold what a format added.
  bool has(std::uint32_t format) const { return format_ >= format; }
  /// The length of a list: each of its elements takes a byte at least.
  /// @param each memory that an element takes [bytes]
  std::size_t length(std::size_t each) {
    const std::uint64_t number = readNumber();
    check(number <= static_cast<std::size_t>(end_ - next_), kTooShort);
    memory_ += number * each;
    check(memory_ <= most_, "there is too much in it");
    return number;
  }
  bool done() const { return next_ == end_; }

 private:
  template <typename Value>
  void read(Value& value) {
    if constexpr (std::is_enum_v<Value>) {
      std::underlying_type_t<Value> number;
      read(number);
      value = static_cast<Value>(number);
    } else if constexpr (std::is_unsigned_v<Value>) {
      const std::uint64_t number = readNumber();
      check(number <= std::numeric_limits<Value>::max(), "a number in it cannot be");
      value = static_cast<Value>(number);
    } else if constexpr (std::is_integral_v<Value>) {
      const std::uint64_t bits = readNumber();
      const auto number = static_cast<std::int64_t>(bits >> 1U ^ (~(bits & 1U) + 1U));
      check(number >= std::numeric_limits<Value>::min() &&
                number <= std::numeric_limits<Value>::max(),
            "a number in it cannot be");
      value = static_cast<Value>(number);
    } else if constexpr (std::is_floating_point_v<Value>) {
      take(&value, sizeof value);
    } else {
      fields(*this, value);
    }
  }
  void read(std::string& text) {
    text.resize(length(1));
    take(text.data(), text.size());
    check(text.size() <= kLongestText && isPrintable(text),
          "a text in it is no UTF-8, has control characters, or is too long");
  }
  void read(std::vector<std::uint8_t>& bytes) {
    bytes.resize(length(1));
    take(bytes.data(), bytes.size());
  }
  template <typename Value>
  void read(std::vector<Value>& list) {
    list.clear();
    for (std::size_t left = length(sizeof(Value)); left > 0; --left) {
      read(list.emplace_back());
    }
  }
  template <typename Value>
  void read(std::set<Value>& set) {
    for (std::size_t left = length(sizeof(Value)); left > 0; --left) {
      Value value;
      read(value);
      check(set.insert(std::move(value)).second, kTwice);
    }
  }
  template <typename Key, typename Value>
  void read(std::map<Key, Value>& map) {
    for (std::size_t left = length(sizeof(std::pair<Key, Value>)); left > 0; --left) {
      std::pair<Key, Value> pair;
      read(pair);
      check(map.insert(std::move(pair)).second, kTwice);
    }
  }
  template <typename First, typename Second>
  void read(std::pair<First, Second>& pair) {
    (*this)(pair.first, pair.second);
  }
  template <typename Value, std::size_t kNumber>
  void read(std::array<Value, kNumber>& array) {
    for (Value& each : array) {
      read(each);
    }
  }
  template <typename Value>
  void read(std::optional<Value>& value) {
    bool is_there = false;
    read(is_there);
    if (is_there) {
      read(value.emplace());
    }
  }
  std::uint64_t readNumber() {
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
  void take(void* data, std::size_t size) {
    check(size <= static_cast<std::size_t>(end_ - next_), kTooShort);
    if (size > 0) {
      std::memcpy(data, next_, size);
      next_ += size;
    }
  }

  static constexpr char kTwice[] = "something is in it twice";
  static constexpr char kTooShort[] = "it ends too soon, or a length in it is wrong";

  const std::uint8_t* next_;
  const std::uint8_t* end_;
  std::uint32_t format_;
  std::size_t most_;
  std::size_t memory_ = 0;  // that was made room for [bytes]
};

}  // namespace self_awareness::ros1
