#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace self_awareness::core::paper {

/// Counts of delays by bin: n_ij(b) of docs/method.md, section 2.1. Every pair of event types has
/// one, so it must be small. An array holds the run of bins that is well filled, a hash table the
/// bins outside, and a map what does not fit into 32 bits.
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
  /// Brings into the cache what add() to this bin probably needs.
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
  /// Smallest bin up to which the given fraction (0 to 1) of the counts lies; 0 if empty.
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
  Entries smallEntriesOutside() const;  // outside the array
  std::uint32_t words() const { return length_ + 2 * capacity_; }

  // First the counts of the array, then the slots of the hash table: a bin and its count each. A
  // slot with a count of 0 is free.
  std::unique_ptr<std::uint32_t[]> memory_;
  std::unique_ptr<Large> large_;  // added to the others
  std::uint32_t first_bin_ = 0;   // of the array
  std::uint32_t length_ = 0;      // of the array
  std::uint32_t capacity_ = 0;    // of the hash table: a power of two, or 0
  std::uint32_t filled_ = 0;      // slots in use
};

bool operator==(const Histogram& a, const Histogram& b);

/// Finds the run of bins for which an array pays most: where the worth of the entries exceeds the
/// number of cells by the most (the largest sum of a contiguous run).
/// @param begin, end entries sorted by bin
/// @param worth of an entry, in cells
std::pair<Histogram::Entries::const_iterator, Histogram::Entries::const_iterator> wellFilled(
    Histogram::Entries::const_iterator begin, Histogram::Entries::const_iterator end,
    std::int64_t worth);

}  // namespace self_awareness::core::paper
