#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace self_awareness::core::paper {

/// Counts of delays per bin: P_ij of the paper before it is normalised. Every pair of event types
/// has one, so it is small: an array over the stretch of bins that is well filled, and a hash
/// table for those outside. What gets beyond 32 bits is in a map.
class Histogram {
 public:
  struct Entry {
    std::int64_t bin = 0;
    std::uint64_t count = 0;
  };
  using Entries = std::vector<Entry>;

  Histogram() = default;
  Histogram(const Histogram& other);
  Histogram& operator=(const Histogram& other);
  Histogram(Histogram&& other) noexcept;
  Histogram& operator=(Histogram&& other) noexcept;
  ~Histogram() = default;

  /// @param bin 0 or more
  void add(std::int64_t bin) {
    const std::uint64_t cell = static_cast<std::uint64_t>(bin) - first_bin_;
    if (cell < length_ && memory_[cell] < kLargestCount) {
      ++memory_[cell];
    } else {
      add(bin, 1);
    }
  }
  void add(std::int64_t bin, std::uint64_t count);
  /// @param entries sorted by bin, each bin once, with counts above 0
  void add(const Entries& entries);
  /// Fetches what an addition to a bin is likely to need into the cache.
  void prefetch(std::int64_t bin) const {
    const std::uint64_t cell = static_cast<std::uint64_t>(bin) - first_bin_;
    __builtin_prefetch(memory_.get() + std::min<std::uint64_t>(cell, length_), 1);
  }
  /// Adds the counts of another histogram with the same binning.
  void merge(const Histogram& other);

  std::uint64_t total() const;
  std::uint64_t count(std::int64_t bin) const;
  bool empty() const { return memory_ == nullptr && large_ == nullptr; }
  /// Bins with counts, sorted.
  Entries entries() const;

  /// Shannon entropy of the normalised histogram [bit]; 0 if it is empty.
  double entropyBits() const;
  /// Smallest bin below or in which the given fraction (0 to 1) of the counts lies; 0 if empty.
  std::int64_t quantile(double fraction) const;

 private:
  using Large = std::map<std::int64_t, std::uint64_t>;  // by bin
  static constexpr std::int64_t kLargestBin = UINT32_MAX;
  static constexpr std::uint32_t kLargestCount = UINT32_MAX;

  std::uint32_t* find(std::int64_t bin) const;
  void insert(std::uint32_t bin, std::uint32_t count);
  void addLarge(std::int64_t bin, std::uint64_t count);
  void rebuild(const Entries& entries);
  /// Length of the array after lengthen(): a quarter more.
  std::uint32_t lengthened() const;
  void lengthen();
  Entries smallEntries() const;
  Entries smallEntriesOutside() const;  // of the array
  std::uint32_t words() const { return length_ + 2 * capacity_; }

  // The counts of the array, then the slots of the hash table: a bin and its count each. A count
  // of 0 is none.
  std::unique_ptr<std::uint32_t[]> memory_;
  std::unique_ptr<Large> large_;  // beside the others
  std::uint32_t first_bin_ = 0;   // of the array
  std::uint32_t length_ = 0;      // of the array
  std::uint32_t capacity_ = 0;    // of the hash table: a power of two, or 0
  std::uint32_t filled_ = 0;      // slots of it
};

bool operator==(const Histogram& a, const Histogram& b);

/// The stretch of bins in which an array pays most: where what its entries are worth exceeds what
/// its cells cost by the most (the largest sum of a contiguous run).
/// @param begin, end entries sorted by bin
/// @param worth of an entry, in cells
std::pair<Histogram::Entries::const_iterator, Histogram::Entries::const_iterator> wellFilled(
    Histogram::Entries::const_iterator begin, Histogram::Entries::const_iterator end,
    std::int64_t worth);

}  // namespace self_awareness::core::paper
