#include "self_awareness/core/paper/histogram.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace self_awareness::core::paper {
namespace {

// An array may have so many cells for every bin with counts: it takes little more memory than
// slots would, and less time.
constexpr std::int64_t kCellsPerEntry = 4;

bool lowerBin(const Histogram::Entry& a, const Histogram::Entry& b) {
  return a.bin < b.bin;
}

}  // namespace

std::pair<Histogram::Entries::const_iterator, Histogram::Entries::const_iterator> wellFilled(
    Histogram::Entries::const_iterator begin, Histogram::Entries::const_iterator end,
    std::int64_t worth) {
  auto best = std::make_pair(end, end);
  std::int64_t best_gain = 0;
  std::int64_t gain = 0;
  auto start = begin;
  for (auto entry = begin; entry != end; ++entry) {
    const std::int64_t cells = entry == begin ? 1 : entry->bin - std::prev(entry)->bin;
    if (gain < cells) {
      start = entry;
      gain = worth - 1;
    } else {
      gain += worth - cells;
    }
    if (gain > best_gain) {
      best_gain = gain;
      best = {start, std::next(entry)};
    }
  }
  return best;
}

Histogram::Histogram(const Histogram& other)
    : large_(other.large_ ? std::make_unique<Large>(*other.large_) : nullptr),
      first_bin_(other.first_bin_),
      length_(other.length_),
      capacity_(other.capacity_),
      filled_(other.filled_) {
  if (other.memory_) {
    memory_.reset(new std::uint32_t[words()]);
    std::copy_n(other.memory_.get(), words(), memory_.get());
  }
}

Histogram& Histogram::operator=(const Histogram& other) {
  return *this = Histogram(other);
}

Histogram::Histogram(Histogram&& other) noexcept {
  *this = std::move(other);
}

Histogram& Histogram::operator=(Histogram&& other) noexcept {
  memory_ = std::move(other.memory_);
  large_ = std::move(other.large_);
  first_bin_ = std::exchange(other.first_bin_, 0);
  length_ = std::exchange(other.length_, 0);
  capacity_ = std::exchange(other.capacity_, 0);
  filled_ = std::exchange(other.filled_, 0);
  return *this;
}

// The count of a bin, in the array or in the hash table; null if it is in neither.
std::uint32_t* Histogram::find(std::int64_t bin) const {
  const std::uint64_t cell = static_cast<std::uint64_t>(bin) - first_bin_;
  if (cell < length_) {
    return &memory_[cell];
  }
  if (capacity_ == 0 || bin > kLargestBin) {
    return nullptr;
  }
  // Neighbouring bins do not collide, and there is always an empty slot.
  std::uint32_t* const slots = &memory_[length_];
  for (std::size_t slot = static_cast<std::uint32_t>(bin);; ++slot) {
    slot &= capacity_ - 1;
    if (slots[2 * slot + 1] == 0) {
      return nullptr;
    }
    if (slots[2 * slot] == static_cast<std::uint32_t>(bin)) {
      return &slots[2 * slot + 1];
    }
  }
}

void Histogram::add(std::int64_t bin, std::uint64_t count) {
  if (count == 0) {
    return;
  }
  if (bin > kLargestBin || count > kLargestCount) {
    addLarge(bin, count);
    return;
  }
  const auto small = static_cast<std::uint32_t>(count);
  if (std::uint32_t* const present = find(bin)) {
    if (*present > kLargestCount - small) {
      addLarge(bin, *present);
      *present = 0;
    }
    *present += small;
  } else if (length_ > 0 && bin >= first_bin_ && bin - first_bin_ < lengthened()) {
    lengthen();
    memory_[static_cast<std::uint64_t>(bin) - first_bin_] = small;
  } else if (filled_ + 1 < capacity_ - capacity_ / 8) {
    insert(static_cast<std::uint32_t>(bin), small);
  } else {
    Entries entries = smallEntries();
    const Entry entry{bin, count};
    entries.insert(std::lower_bound(entries.begin(), entries.end(), entry, lowerBin), entry);
    rebuild(entries);
  }
}

// Adds a new bin to the hash table, which must have room for it.
void Histogram::insert(std::uint32_t bin, std::uint32_t count) {
  std::uint32_t* const slots = &memory_[length_];
  std::size_t slot = bin & (capacity_ - 1);
  while (slots[2 * slot + 1] != 0) {
    slot = (slot + 1) & (capacity_ - 1);
  }
  slots[2 * slot] = bin;
  slots[2 * slot + 1] = count;
  ++filled_;
}

void Histogram::addLarge(std::int64_t bin, std::uint64_t count) {
  if (!large_) {
    large_ = std::make_unique<Large>();
  }
  (*large_)[bin] += count;
}

std::uint32_t Histogram::lengthened() const {
  const std::uint64_t length = std::uint64_t{length_} + length_ / 4 + 1;
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(length, kLargestBin - first_bin_));
}

// Delays since a rare event grow bin by bin, so the cost of adding one must not grow with the
// number of bins.
void Histogram::lengthen() {
  const Entries entries = smallEntriesOutside();
  const std::uint32_t length = lengthened();
  auto memory = std::make_unique<std::uint32_t[]>(length + 2 * capacity_);
  std::copy_n(memory_.get(), length_, memory.get());
  memory_ = std::move(memory);
  length_ = length;
  filled_ = 0;
  for (const Entry& entry : entries) {
    const auto bin = static_cast<std::uint32_t>(entry.bin);
    const auto count = static_cast<std::uint32_t>(entry.count);
    if (bin >= first_bin_ && bin - first_bin_ < length_) {
      memory_[bin - first_bin_] = count;
    } else {
      insert(bin, count);
    }
  }
}

// Divides the entries between the array and the hash table again.
void Histogram::rebuild(const Entries& entries) {
  const auto [first, last] = wellFilled(entries.begin(), entries.end(), kCellsPerEntry);
  first_bin_ = 0;
  length_ = 0;
  if (first != last) {
    first_bin_ = static_cast<std::uint32_t>(first->bin);
    length_ = static_cast<std::uint32_t>(std::prev(last)->bin - first->bin + 1);
  }
  const auto outside = entries.size() - static_cast<std::size_t>(std::distance(first, last));
  capacity_ = outside > 0 ? 4 : 0;
  while (capacity_ * 5 / 8 < outside) {
    capacity_ *= 2;
  }
  filled_ = 0;
  memory_ = std::make_unique<std::uint32_t[]>(words());
  for (auto entry = entries.begin(); entry != entries.end(); ++entry) {
    const auto bin = static_cast<std::uint32_t>(entry->bin);
    const auto count = static_cast<std::uint32_t>(entry->count);
    if (entry >= first && entry < last) {
      memory_[bin - first_bin_] = count;
    } else {
      insert(bin, count);
    }
  }
}

void Histogram::merge(const Histogram& other) {
  add(other.entries());
}

void Histogram::add(const Entries& entries) {
  // New bins are added all at once: one after the other, each might cause a rebuild.
  Entries added;
  for (const Entry& entry : entries) {
    if (entry.bin > kLargestBin || entry.count > kLargestCount || find(entry.bin) != nullptr) {
      add(entry.bin, entry.count);
    } else {
      added.push_back(entry);
    }
  }
  if (!added.empty()) {
    const Entries present = smallEntries();
    Entries all;
    all.reserve(present.size() + added.size());
    std::merge(present.begin(), present.end(), added.begin(), added.end(), std::back_inserter(all),
               lowerBin);
    rebuild(all);
  }
}

std::uint64_t Histogram::total() const {
  std::uint64_t total = 0;
  for (std::uint32_t cell = 0; cell < length_; ++cell) {
    total += memory_[cell];
  }
  for (std::uint32_t slot = 0; slot < capacity_; ++slot) {
    total += memory_[length_ + 2 * slot + 1];
  }
  if (large_) {
    for (const auto& [bin, count] : *large_) {
      total += count;
    }
  }
  return total;
}

std::uint64_t Histogram::count(std::int64_t bin) const {
  const std::uint32_t* const small = find(bin);
  std::uint64_t count = small != nullptr ? *small : 0;
  if (large_) {
    const auto entry = large_->find(bin);
    count += entry != large_->end() ? entry->second : 0;
  }
  return count;
}

// Entries of the hash table.
Histogram::Entries Histogram::smallEntriesOutside() const {
  Entries outside;
  for (std::uint32_t slot = 0; slot < capacity_; ++slot) {
    const std::uint32_t* const bin = &memory_[length_ + 2 * slot];
    if (bin[1] > 0) {
      outside.push_back({bin[0], bin[1]});
    }
  }
  std::sort(outside.begin(), outside.end(), lowerBin);
  return outside;
}

Histogram::Entries Histogram::smallEntries() const {
  const Entries outside = smallEntriesOutside();
  Entries entries;
  entries.reserve(outside.size() + length_ + 1);
  const auto behind =
      std::lower_bound(outside.begin(), outside.end(), Entry{first_bin_, 0}, lowerBin);
  entries.insert(entries.end(), outside.begin(), behind);
  for (std::uint32_t cell = 0; cell < length_; ++cell) {
    if (memory_[cell] > 0) {
      entries.push_back({std::int64_t{first_bin_} + cell, memory_[cell]});
    }
  }
  entries.insert(entries.end(), behind, outside.end());
  return entries;
}

Histogram::Entries Histogram::entries() const {
  Entries entries = smallEntries();
  if (large_) {
    for (const auto& [bin, count] : *large_) {
      const auto place = std::lower_bound(entries.begin(), entries.end(), Entry{bin, 0}, lowerBin);
      if (place != entries.end() && place->bin == bin) {
        place->count += count;
      } else {
        entries.insert(place, {bin, count});
      }
    }
  }
  return entries;
}

double Histogram::entropyBits() const {
  const auto all = static_cast<double>(total());
  double entropy = 0;
  for (const Entry& entry : entries()) {
    const double p = static_cast<double>(entry.count) / all;
    entropy -= p * std::log2(p);
  }
  return std::max(entropy, 0.0);  // a single bin gives -0
}

std::int64_t Histogram::quantile(double fraction) const {
  const double wanted = fraction * static_cast<double>(total());
  std::uint64_t below = 0;
  for (const Entry& entry : entries()) {
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
  const std::vector<Histogram::Entry> in_a = a.entries();
  const std::vector<Histogram::Entry> in_b = b.entries();
  return std::equal(in_a.begin(), in_a.end(), in_b.begin(), in_b.end(), same);
}

}  // namespace self_awareness::core::paper
