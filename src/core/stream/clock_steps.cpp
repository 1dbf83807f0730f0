#include "self_awareness/core/stream/clock_steps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "self_awareness/core/stream/clock.h"

namespace self_awareness::core {
namespace {

// What a robot does more often is its way: it may fall silent as a whole.
constexpr std::size_t kMostSteps = 3;
// Other silences are so many times shorter, and other gaps of what comes all the time.
constexpr std::int64_t kTimesLonger = 8;
constexpr std::int64_t kTimesLongerThanGaps = 4;
// What comes all the time has so many gaps, and so many events before and after a step.
constexpr std::size_t kFewestGaps = 50;
constexpr std::size_t kFewestEventsAround = 20;
// Of the gaps of a type, so many at either end are not usual.
constexpr double kUnusual = 0.005;
// Share of the types that must go on as usual, but for some that are late just then.
constexpr double kGoOn = 0.8;
// The silence is a step if it is as improbable as this that all go on as usual after a pause.
constexpr double kMostByChance = 0.05;

/// A time without any event.
struct Silence {
  std::int64_t length = 0;  // [ns]
  std::size_t next = 0;     // index of the event that ends it
};

/// A range of times [ns].
struct Range {
  std::int64_t low = 0;
  std::int64_t high = 0;
};

/// The longest silences between two events in a row, the longest first; steps that stamps say
/// themselves are left out.
std::vector<Silence> longestSilences(const std::vector<Event>& events, std::size_t number) {
  std::vector<Silence> longest;
  for (std::size_t i = 1; i < events.size(); ++i) {
    const Silence silence{events[i].stamp - events[i - 1].stamp, i};
    if (isClockStep(events[i - 1].stamp, events[i].stamp) ||
        (longest.size() == number && silence.length <= longest.back().length)) {
      continue;
    }
    const auto place =
        std::upper_bound(longest.begin(), longest.end(), silence,
                         [](const Silence& a, const Silence& b) { return a.length > b.length; });
    longest.insert(place, silence);
    longest.resize(std::min(longest.size(), number));
  }
  return longest;
}

/// The gaps of an event type.
struct Type {
  std::size_t events = 0;
  std::vector<std::int64_t> gaps;                            // [ns]; in order, once counted
  std::array<std::size_t, kMostSteps> before{};              // events before each silence
  std::array<std::optional<std::int64_t>, kMostSteps> over;  // the gap that holds it [ns]

  bool comesAllTheTime(std::size_t k, const Silence& silence) const {
    const auto longer = gaps.end() - std::lower_bound(gaps.begin(), gaps.end(),
                                                      silence.length / kTimesLongerThanGaps);
    return over[k] && gaps.size() >= kFewestGaps &&
           static_cast<std::size_t>(longer) <= kMostSteps && before[k] >= kFewestEventsAround &&
           events - before[k] >= kFewestEventsAround;
  }
  /// The gaps that are usual.
  Range usual() const {
    const std::size_t unusual =
        kMostSteps + static_cast<std::size_t>(kUnusual * static_cast<double>(gaps.size()));
    return {gaps[unusual - kMostSteps], gaps[gaps.size() - 1 - unusual]};
  }
};

std::vector<Type> typesOf(const std::vector<Event>& events, const std::vector<Silence>& silences) {
  std::vector<Type> types;
  std::vector<std::optional<std::int64_t>> last;  // stamps [ns]
  for (std::size_t i = 0; i < events.size(); ++i) {
    const std::int64_t stamp = events[i].stamp;
    const EventId id = events[i].id;
    if (id >= types.size()) {
      types.resize(id + 1);
      last.resize(id + 1);
    }
    if (i > 0 && isClockStep(events[i - 1].stamp, stamp)) {
      std::fill(last.begin(), last.end(), std::nullopt);
    }
    Type& type = types[id];
    for (std::size_t k = 0; k < silences.size(); ++k) {
      if (i < silences[k].next) {
        ++type.before[k];
      } else if (!type.over[k] && last[id] && type.before[k] == type.events) {
        type.over[k] = stamp - *last[id];
      }
    }
    if (last[id]) {
      type.gaps.push_back(stamp - *last[id]);
    }
    last[id] = stamp;
    ++type.events;
  }
  for (Type& type : types) {
    std::sort(type.gaps.begin(), type.gaps.end());
  }
  return types;
}

/// Whether all goes on after a silence as if it had not been.
/// @param most time that may really have passed [ns]
bool goesOn(const std::vector<Type>& types, std::size_t k, const Silence& silence,
            std::int64_t most) {
  std::vector<Range> passed;   // the time that really passed, as each type has it
  std::vector<double> shares;  // of its gaps that this range covers
  for (const Type& type : types) {
    if (type.comesAllTheTime(k, silence)) {
      const Range usual = type.usual();
      const std::int64_t around = *type.over[k] - silence.length;
      passed.push_back({usual.low - around, usual.high - around});
      const double median = static_cast<double>(type.gaps[type.gaps.size() / 2]);
      shares.push_back(std::min(
          1.0, static_cast<double>(std::max<std::int64_t>(usual.high - usual.low, 1)) / median));
    }
  }
  const auto needed =
      static_cast<std::size_t>(std::ceil(kGoOn * static_cast<double>(passed.size())));
  for (const Range& candidate : passed) {
    const std::int64_t time = std::max<std::int64_t>(candidate.low, 0);
    if (time > most) {
      continue;
    }
    std::size_t number = 0;
    double chance = 1;
    std::int64_t narrowest = most;
    for (std::size_t i = 0; i < passed.size(); ++i) {
      if (passed[i].low <= time && time <= passed[i].high) {
        ++number;
        chance *= shares[i];
        narrowest = std::min(narrowest, std::max<std::int64_t>(passed[i].high - passed[i].low, 1));
      }
    }
    // One of so many times would do as well.
    chance *= static_cast<double>(most) / static_cast<double>(narrowest);
    if (number >= needed && chance <= kMostByChance) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::vector<std::int64_t> findClockSteps(const std::vector<Event>& events) {
  std::vector<Silence> silences = longestSilences(events, kMostSteps + 1);
  std::vector<std::int64_t> steps;
  if (silences.size() <= kMostSteps) {
    return steps;
  }
  const std::int64_t usual = silences.back().length;
  const auto end = std::find_if(silences.begin(), silences.end(), [usual](const Silence& silence) {
    return silence.length < std::max(kSmallestStep, kTimesLonger * usual);
  });
  silences.erase(end, silences.end());
  if (silences.empty()) {
    return steps;
  }
  const std::vector<Type> types = typesOf(events, silences);
  for (std::size_t k = 0; k < silences.size(); ++k) {
    if (goesOn(types, k, silences[k], usual)) {
      steps.push_back(events[silences[k].next].stamp);
    }
  }
  std::sort(steps.begin(), steps.end());
  return steps;
}

ClockSteps::ClockSteps(std::vector<std::int64_t> stamps) : stamps_(std::move(stamps)) {
  std::sort(stamps_.begin(), stamps_.end());
}

bool ClockSteps::between(std::int64_t previous, std::int64_t current) const {
  const auto next = std::upper_bound(stamps_.begin(), stamps_.end(), previous);
  return next != stamps_.end() && *next <= current;
}

}  // namespace self_awareness::core
