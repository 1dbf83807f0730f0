#pragma once

#include <array>
#include <cstdint>
#include <map>

#include "self_awareness/core/stream/attributes.h"

namespace self_awareness::core::evidence {

/// The first messages may be odd, as those of a driver that starts: for so long after the first
/// one of an event type in a recording [ns], its attributes do not count, and for so long after
/// the first one of all, no silence of all. The detector forgets them as well (docs/method.md,
/// section 4.4).
constexpr std::int64_t kSettled = 5000000000;

/// Numbers of messages by class; classes without any are left out.
using ClassCounts = std::map<std::uint8_t, std::uint64_t>;

/// Number of all messages.
std::uint64_t total(const ClassCounts& counts);
/// The class that a share (0 to 1) of the messages does not exceed; 0 without messages.
std::uint8_t quantile(const ClassCounts& counts, double share);

/// What training counts of the attributes of an event type's messages (docs/method.md,
/// section 3.10). Of those in the first kSettled of a recording, it only knows that they
/// came. The counts of two trainings add up.
struct AttributeCounts {
  ClassCounts ages;   ///< of messages with a header: Attributes::age
  ClassCounts rises;  ///< ageClass() of how much older they were than of late (AgeLevel)
  ClassCounts sizes;  ///< Attributes::size, of all messages that count
  /// By Attributes::Step; kNotKnown of those that do not count.
  std::array<std::uint64_t, Attributes::kSteps> steps{};
  std::uint64_t repeats = 0;        ///< messages with the bytes of the one before
  std::int64_t longest_repeat = 0;  ///< the longest time with the same bytes [ns]

  void merge(const AttributeCounts& other);
  /// Messages of which anything is known.
  std::uint64_t known() const;
  /// Those of them that count.
  std::uint64_t counted() const { return total(sizes); }
  /// Messages with a number that follows another one.
  std::uint64_t numbered() const;
  /// Those of them before which messages are missing.
  std::uint64_t losses() const;
  /// Their share; 0 without numbers.
  double shareOfLosses() const;
};

bool operator==(const AttributeCounts& a, const AttributeCounts& b);

}  // namespace self_awareness::core::evidence
