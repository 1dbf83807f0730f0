#include "core/paper/delay_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>

namespace self_awareness::core::paper {
namespace {

// Larger bins, and this one, are in no array.
constexpr std::int64_t kLargestBin = std::numeric_limits<std::int32_t>::max();
// Stands after an array if bins outside have counts: they are among the scattered ones.
constexpr std::int32_t kScattered = -1;
// This cell holds 0.
constexpr std::uint32_t kEmptyCell = 0;

// Number of pairs that are worked on together.
constexpr std::size_t kBlock = 64;

// Number of terms that are added up side by side, in vector registers where there are any.
constexpr std::size_t kLanes = 4;
using Int4 = std::int32_t __attribute__((vector_size(kLanes * sizeof(std::int32_t))));
using Double4 = double __attribute__((vector_size(kLanes * sizeof(double))));

void load(const double* values, Double4& lanes) {
  std::memcpy(&lanes, values, sizeof(lanes));
}

// A bin with counts is worth so many cells of an array: scattered, it takes as much memory as six,
// and a search.
constexpr std::int64_t kCellsPerBin = 8;

}  // namespace

void DelayTable::append(const Histogram::Entries& entries) {
  std::uint64_t total = 0;
  bool small = true;
  for (const Histogram::Entry& entry : entries) {
    total += entry.count;
    small = small && entry.count <= std::numeric_limits<std::int32_t>::max();
  }
  double entropy = 0;
  for (const Histogram::Entry& entry : entries) {
    const double p = static_cast<double>(entry.count) / static_cast<double>(total);
    entropy -= p * std::log2(p);
  }
  const auto fit = std::partition_point(
      entries.begin(), entries.end(),
      [&](const Histogram::Entry& entry) { return small && entry.bin < kLargestBin; });
  const auto [first, last] = wellFilled(entries.begin(), fit, kCellsPerBin);

  const auto from = static_cast<EventId>(size());
  const std::int64_t first_bin = first == last ? 0 : first->bin;
  const std::int64_t length = first == last ? 0 : std::prev(last)->bin - first_bin + 1;
  const std::size_t start = counts_.size();
  const std::size_t end = start + static_cast<std::size_t>(length);
  if (end >= std::numeric_limits<std::uint32_t>::max()) {
    throw std::length_error("the histograms of an event type have too many bins");
  }
  counts_.resize(end + 1, 0);
  for (auto entry = entries.begin(); entry != entries.end(); ++entry) {
    if (entry >= first && entry < last) {
      counts_[start + static_cast<std::size_t>(entry->bin - first_bin)] =
          static_cast<std::int32_t>(entry->count);
    } else {
      scattered_.push_back({from, *entry});
      counts_[end] = kScattered;
    }
  }
  scales_.push_back(total > 0 ? 1 / static_cast<double>(total) : 0);
  entropies_.push_back(std::max(entropy, 0.0));  // a single bin gives -0
  first_bins_.push_back(static_cast<std::uint32_t>(first_bin));
  starts_.push_back(static_cast<std::uint32_t>(end + 1));
}

void DelayTable::finish() {
  // The last lanes read beyond the last pair.
  const std::size_t lanes = (size() + kLanes - 1) / kLanes * kLanes;
  scales_.resize(lanes, 0);
  entropies_.resize(lanes, 0);
  scales_.shrink_to_fit();
  entropies_.shrink_to_fit();
  first_bins_.shrink_to_fit();
  starts_.shrink_to_fit();
  counts_.shrink_to_fit();
  scattered_.shrink_to_fit();
}

double DelayTable::scatteredCount(EventId from, std::int64_t bin) const {
  const auto place =
      std::lower_bound(scattered_.begin(), scattered_.end(), std::make_pair(from, bin),
                       [](const Scattered& scattered, const auto& wanted) {
                         return std::make_pair(scattered.from, scattered.entry.bin) < wanted;
                       });
  const bool found = place != scattered_.end() && place->from == from && place->entry.bin == bin;
  return found ? static_cast<double>(place->entry.count) : 0;
}

// Finds the cells of the delays since the types `first` to `end`; for types not seen, the empty
// one.
void DelayTable::findCells(const SeenTypes& seen, std::uint64_t mark, const DelayBins& bins,
                           std::size_t first, std::size_t end, std::uint32_t* cells) const {
  const std::uint64_t* const marks = seen.marks().data() + first;
  const std::uint32_t* const masks = seen.masks().data() + first;
  const std::uint32_t* const first_bins = first_bins_.data() + first;
  const std::uint32_t* const starts = starts_.data() + first;
  const std::size_t terms = end - first;
  std::array<std::int32_t, kBlock> delays;
  const int shift = bins.remainderBits();
  // If 31 bits hold the bins, all differences are computed side by side. They do, but for late
  // stamps, horizons, and recordings of months (at 10 ms).
  const bool late = static_cast<std::int64_t>(mark - seen.newest()) < 0;
  if (!late && bins.lastBin() > kLargestBin &&
      (mark - seen.oldest()) >> shift < static_cast<std::uint64_t>(kLargestBin)) {
    for (std::size_t i = 0; i < terms; ++i) {
      delays[i] = static_cast<std::int32_t>((mark - marks[i]) >> shift);
    }
  } else {
    for (std::size_t i = 0; i < terms; ++i) {
      delays[i] = static_cast<std::int32_t>(std::min(bins.bin(marks[i], mark), kLargestBin));
    }
  }
  for (std::size_t i = 0; i < terms; ++i) {
    const std::uint32_t length = starts[i + 1] - starts[i] - 1;
    const std::uint32_t cell = static_cast<std::uint32_t>(delays[i]) - first_bins[i];
    cells[i] = (starts[i] + std::min(cell, length)) & masks[i];
  }
}

DelayTable::Sums DelayTable::sums(const SeenTypes& seen, std::uint64_t mark,
                                  const DelayBins& bins) const {
  Double4 probabilities = {};
  Double4 with_entropies = {};
  Sums scattered;
  for (std::size_t first = 0; first < size(); first += kBlock) {
    const std::size_t end = std::min(first + kBlock, size());
    std::array<std::uint32_t, kBlock> cells;
    findCells(seen, mark, bins, first, end, cells.data());
    // A row of one block is in cache, or soon will be.
    for (std::size_t i = 0; i < end - first && size() > kBlock; ++i) {
      __builtin_prefetch(&counts_[cells[i]]);
    }
    std::fill(cells.begin() + (end - first), cells.end(), kEmptyCell);
    // No branch on what is looked up: so no look-up waits for another. What kScattered stands for
    // is rare and comes later.
    Int4 signs = {};
    for (std::size_t i = 0; i < end - first; i += kLanes) {
      const Int4 counts = {counts_[cells[i]], counts_[cells[i + 1]], counts_[cells[i + 2]],
                           counts_[cells[i + 3]]};
      Double4 scales;
      Double4 entropies;
      load(&scales_[first + i], scales);
      load(&entropies_[first + i], entropies);
      const Double4 probability = __builtin_convertvector(counts, Double4) * scales;
      probabilities += probability;
      with_entropies += entropies * probability;
      signs |= counts;
    }
    if ((signs[0] | signs[1] | signs[2] | signs[3]) < 0) {
      for (std::size_t i = 0; i < end - first; ++i) {
        if (counts_[cells[i]] == kScattered) {
          const auto from = static_cast<EventId>(first + i);
          const double count = scatteredCount(from, bins.bin(seen.marks()[from], mark));
          const double probability = (count - kScattered) * scales_[from];  // added to that above
          scattered.probabilities += probability;
          scattered.with_entropies += entropies_[from] * probability;
        }
      }
    }
  }
  const auto total = [](const Double4& lanes) {
    return lanes[0] + lanes[1] + lanes[2] + lanes[3];
  };
  return {total(probabilities) + scattered.probabilities,
          total(with_entropies) + scattered.with_entropies};
}

double DelayTable::probability(EventId from, std::int64_t bin) const {
  const std::size_t length = starts_.at(from + 1) - starts_[from] - 1;
  const std::int64_t cell = bin - first_bins_[from];
  const bool inside = cell >= 0 && cell < static_cast<std::int64_t>(length);
  const double count =
      inside ? counts_[starts_[from] + static_cast<std::size_t>(cell)] : scatteredCount(from, bin);
  return count * scales_[from];
}

std::vector<double> DelayTable::meanProbabilities() const {
  std::vector<double> means(size());
  for (EventId from = 0; from < means.size(); ++from) {
    for (std::uint32_t cell = starts_[from]; cell + 1 < starts_[from + 1]; ++cell) {
      const double p = counts_[cell] * scales_[from];
      means[from] += p * p;
    }
  }
  for (const Scattered& scattered : scattered_) {
    const double p = static_cast<double>(scattered.entry.count) * scales_[scattered.from];
    means[scattered.from] += p * p;
  }
  return means;
}

}  // namespace self_awareness::core::paper
