#include <algorithm>
#include <cstddef>
#include <tuple>

#include "recording_files.h"
#include "self_awareness/core/stream/clock.h"

namespace self_awareness::ros1 {
namespace {

// A bag with more of them is in no order of time.
constexpr std::size_t kMostSteps = 3;
// Delay that is taken for the one across a step, which nobody knows [ns].
constexpr std::int64_t kDelay = 1000000;

auto placeInBag(const BagIndexEntry& entry) {
  return std::tie(entry.chunk, entry.offset);
}

/// Whether a message that came much later than others lies before them in the file.
bool goesBack(const std::vector<BagIndexEntry>& entries) {
  std::size_t before = 0;               // the first one that is hardly earlier
  const BagIndexEntry* last = nullptr;  // in the file, of those before
  return std::any_of(entries.begin(), entries.end(), [&](const BagIndexEntry& entry) {
    for (; entries[before].stamp < entry.stamp - core::kLatestEvent; ++before) {
      if (last == nullptr || placeInBag(*last) < placeInBag(entries[before])) {
        last = &entries[before];
      }
    }
    return last != nullptr && placeInBag(entry) < placeInBag(*last);
  });
}

/// Messages in a row, between two steps.
struct Stretch {
  std::size_t first = 0;    // index of its first message
  std::int64_t latest = 0;  // stamp [ns]
  std::vector<bool> hears;  // connections
};

/// @param entries in the order of the file
std::vector<Stretch> stretchesOf(const std::vector<BagIndexEntry>& entries,
                                 std::size_t connections) {
  std::vector<Stretch> stretches;
  for (std::size_t i = 0; i < entries.size() && stretches.size() <= kMostSteps + 1; ++i) {
    const std::int64_t stamp = entries[i].stamp;
    if (i == 0 || stamp < entries[i - 1].stamp - core::kLatestEvent) {
      stretches.push_back({i, stamp, std::vector<bool>(connections)});
    }
    stretches.back().latest = std::max(stretches.back().latest, stamp);
    stretches.back().hears[entries[i].connection] = true;
  }
  return stretches;
}

/// Whether half of those that are heard in a stretch are heard in the other, too.
bool goOn(const Stretch& one, const Stretch& other) {
  std::ptrdiff_t both = 0;
  for (std::size_t i = 0; i < one.hears.size(); ++i) {
    both += one.hears[i] && other.hears[i] ? 1 : 0;
  }
  const auto number = [](const Stretch& stretch) {
    return std::count(stretch.hears.begin(), stretch.hears.end(), true);
  };
  return 2 * both >= std::max(number(one), number(other));
}

}  // namespace

std::vector<SetBack> countOn(BagIndex& index) {
  std::vector<SetBack> steps;
  if (!goesBack(index.entries)) {
    return steps;
  }
  std::vector<BagIndexEntry> entries = index.entries;
  std::sort(entries.begin(), entries.end(), [](const BagIndexEntry& a, const BagIndexEntry& b) {
    return placeInBag(a) < placeInBag(b);
  });
  const std::vector<Stretch> stretches = stretchesOf(entries, index.connections.size());
  if (stretches.size() > kMostSteps + 1 ||
      std::adjacent_find(stretches.begin(), stretches.end(),
                         [](const Stretch& one, const Stretch& other) {
                           return !goOn(one, other);
                         }) != stretches.end()) {
    return steps;
  }
  std::int64_t counted_on = 0;
  for (std::size_t k = 1; k < stretches.size(); ++k) {
    const std::size_t first = stretches[k].first;
    const std::size_t end = k + 1 < stretches.size() ? stretches[k + 1].first : entries.size();
    const std::int64_t by = stretches[k - 1].latest - entries[first].stamp;
    counted_on += by + kDelay;
    steps.push_back({entries[first].stamp + counted_on, by, counted_on});
    for (std::size_t i = first; i < end; ++i) {
      entries[i].stamp += counted_on;
    }
  }
  std::sort(entries.begin(), entries.end(), Earlier());
  index.entries = std::move(entries);
  return steps;
}

BagIndexEntry asStored(BagIndexEntry entry, const std::vector<SetBack>& steps) {
  const auto next = std::find_if(steps.begin(), steps.end(),
                                 [&](const SetBack& step) { return step.stamp > entry.stamp; });
  entry.stamp -= next == steps.begin() ? 0 : (next - 1)->counted_on;
  return entry;
}

}  // namespace self_awareness::ros1
