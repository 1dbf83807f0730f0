#pragma once

#include <cstdint>

namespace self_awareness::core {

/// What a message is besides its time and its type, in classes of one byte (docs/method.md,
/// section 3.10). The same classes are heard live, read from bags and kept in event logs, so that
/// all judge alike.
struct Attributes {
  /// What the number of a message says, after that of the message before it (header.seq).
  enum class Step : std::uint8_t {
    kNotKnown,  ///< there is no header, or no message before it
    kNext,
    kSame,      ///< it stands still: the source does not count
    kLostOne,   ///< one message is missing
    kLostFew,   ///< 2 or 3
    kLostSome,  ///< 4 to 15
    kLostMany,  ///< 16 to kMostLost
    kRestart    ///< it goes back, or leaps
  };
  static constexpr std::uint8_t kSteps = 8;          ///< number of steps
  static constexpr std::uint32_t kMostLost = 1000;   ///< of a larger gap nothing is known
  static constexpr std::uint8_t kNoAge = 0;          ///< age of a message without a header
  static constexpr std::uint8_t kZeroStamp = 1;      ///< age of a message with the stamp 0
  static constexpr std::uint8_t kYoungest = 2;       ///< the first class of a true age
  static constexpr double kAgeStep = 0.0906;         ///< width of a class of ages, as a share
  static constexpr double kAheadStep = 0.1893;       ///< the same of stamps in the future
  static constexpr std::uint8_t kNoSize = 0;         ///< nothing is known of the message
  static constexpr std::uint8_t kLargestSize = 255;  ///< the last class

  std::uint8_t age = kNoAge;    ///< class of the time since header.stamp: ageClass()
  std::uint8_t size = kNoSize;  ///< class of the size: sizeClass()
  Step step = Step::kNotKnown;
  bool same = false;  ///< the bytes after the header are those of the message before it

  /// Whether anything is known of the message. Of events of older logs, nothing is.
  bool isKnown() const { return size != kNoSize; }
  /// Whether its age is that of a stamp.
  bool hasAge() const { return age >= kYoungest; }
  /// Whether messages are missing before it.
  bool isAfterLoss() const { return Step::kLostOne <= step && step <= Step::kLostMany; }
};

inline bool operator==(const Attributes& a, const Attributes& b) {
  return a.age == b.age && a.size == b.size && a.step == b.step && a.same == b.same;
}

/// Class of an age [ns], kYoungest or more; older ages have larger classes. One class has all
/// below 1 ms. From there to 36 min there are eight an octave (a step of 9 %), for stamps in the
/// future four (19 %); the last ones have all beyond.
std::uint8_t ageClass(std::int64_t age);
/// The age that stands for a class from kYoungest on [s]; negative: a stamp in the future.
double ageOf(std::uint8_t age_class);

/// Class of a size [bytes], eight an octave (a step of 9 %), never kNoSize.
std::uint8_t sizeClass(std::uint64_t bytes);
/// The size that stands for a class other than kNoSize [bytes].
double sizeOf(std::uint8_t size_class);

/// What the number of a message says after that of the message before it; both may run over.
Attributes::Step stepOf(std::uint32_t before, std::uint32_t number);

/// The attributes in one number, for arrays: 8 bits of the age, then size, step and same.
std::uint32_t packed(const Attributes& attributes);
/// @throw std::invalid_argument if packed() makes no such number
Attributes unpackedAttributes(std::uint32_t number);

}  // namespace self_awareness::core
