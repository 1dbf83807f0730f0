#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "self_awareness/core/paper/binning.h"
#include "self_awareness/core/stream/event.h"

namespace self_awareness::core::paper {

/// Finds the bins of delays between stamps (docs/method.md, section 2.1). They are those of
/// Binning, without a division for every delay. Each stamp is divided once, into a mark: its upper
/// bits are the quotient, its lower ones the remainder. The upper bits of the difference of two
/// marks are the bin, as the lower ones borrow from them. Exact for delays up to 2^61 ns, 73
/// years.
class DelayBins {
 public:
  /// @throw std::invalid_argument if a value of the binning is out of range
  explicit DelayBins(const Binning& binning);

  /// Mark of a stamp [ns].
  std::uint64_t mark(std::int64_t stamp) const {
    const std::int64_t remainder = stamp % bin_size_;
    const std::int64_t below = remainder < 0 ? 1 : 0;
    return (static_cast<std::uint64_t>(stamp / bin_size_ - below) << remainder_bits_) +
           static_cast<std::uint64_t>(remainder + below * bin_size_);
  }
  /// Bin of the delay from the mark `from` to the mark `to`.
  std::int64_t bin(std::uint64_t from, std::uint64_t to) const {
    const auto difference = static_cast<std::int64_t>(to - from);
    return std::min(std::max<std::int64_t>(difference, 0) >> remainder_bits_, last_bin_);
  }
  /// Number of lower bits of a mark.
  int remainderBits() const { return remainder_bits_; }
  /// Largest bin that a delay can have.
  std::int64_t lastBin() const { return last_bin_; }

 private:
  std::int64_t bin_size_;  // [ns]
  std::int64_t last_bin_;
  int remainder_bits_ = 0;
};

/// The event types seen so far in a recording ("E" of eq. 3), with the marks of their last events.
class SeenTypes {
 public:
  /// Makes room for a number of event types.
  void resize(std::size_t types);
  void clear();
  /// @param id less than the number of event types
  void add(EventId id, std::uint64_t mark);

  std::size_t size() const { return marks_.size(); }
  bool contains(EventId id) const { return masks_[id] != 0; }
  /// By id: all bits set if the type was seen, none if not.
  const std::vector<std::uint32_t>& masks() const { return masks_; }
  /// Mark of the last event, by id; valid for types that were seen.
  const std::vector<std::uint64_t>& marks() const { return marks_; }
  /// Smallest mark so far.
  std::uint64_t oldest() const { return oldest_; }
  /// Largest mark so far.
  std::uint64_t newest() const { return newest_; }

 private:
  std::vector<std::uint32_t> masks_;
  std::vector<std::uint64_t> marks_;
  std::uint64_t oldest_ = 0;
  std::uint64_t newest_ = 0;
  bool any_ = false;
};

}  // namespace self_awareness::core::paper
