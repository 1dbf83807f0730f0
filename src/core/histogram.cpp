#include "self_awareness/core/histogram.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace self_awareness::core {
namespace {

bool lowerBin(const Histogram::Entry& entry, std::int64_t bin) {
  return entry.bin < bin;
}

}  // namespace

std::int64_t Binning::bin(std::int64_t delay) const {
  const std::int64_t index = std::max<std::int64_t>(delay, 0) / bin_size;
  return horizon_bins > 0 ? std::min(index, horizon_bins) : index;
}

void Binning::validate() const {
  if (bin_size <= 0) {
    throw std::invalid_argument("bin size must be more than 0 ns, it is " +
                                std::to_string(bin_size));
  }
  if (horizon_bins < 0) {
    throw std::invalid_argument("horizon must be 0 (unbounded) or a number of bins, it is " +
                                std::to_string(horizon_bins));
  }
}

bool operator==(const Binning& a, const Binning& b) {
  return a.bin_size == b.bin_size && a.horizon_bins == b.horizon_bins;
}

void Histogram::add(std::int64_t bin, std::uint64_t count) {
  const auto place = std::lower_bound(entries_.begin(), entries_.end(), bin, lowerBin);
  if (place != entries_.end() && place->bin == bin) {
    place->count += count;
  } else {
    entries_.insert(place, Entry{bin, count});
  }
  total_ += count;
}

void Histogram::merge(const Histogram& other) {
  for (const Entry& entry : other.entries_) {
    add(entry.bin, entry.count);
  }
}

std::uint64_t Histogram::count(std::int64_t bin) const {
  const auto place = std::lower_bound(entries_.begin(), entries_.end(), bin, lowerBin);
  return place != entries_.end() && place->bin == bin ? place->count : 0;
}

double Histogram::entropyBits() const {
  double entropy = 0;
  for (const Entry& entry : entries_) {
    const double p = static_cast<double>(entry.count) / static_cast<double>(total_);
    entropy -= p * std::log2(p);
  }
  return std::max(entropy, 0.0);  // a single bin gives -0
}

std::int64_t Histogram::quantile(double fraction) const {
  const double wanted = fraction * static_cast<double>(total_);
  std::uint64_t below = 0;
  for (const Entry& entry : entries_) {
    below += entry.count;
    if (static_cast<double>(below) >= wanted) {
      return entry.bin;
    }
  }
  return 0;
}

bool operator==(const Histogram& a, const Histogram& b) {
  const auto same = [](const Histogram::Entry& x, const Histogram::Entry& y) {
    return x.bin == y.bin && x.count == y.count;
  };
  return std::equal(a.entries().begin(), a.entries().end(), b.entries().begin(), b.entries().end(),
                    same);
}

}  // namespace self_awareness::core
