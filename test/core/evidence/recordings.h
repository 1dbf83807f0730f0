#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <random>
#include <string>
#include <vector>

#include "self_awareness/core/evidence/channel/watched.h"
#include "self_awareness/core/evidence/count/trainer.h"

/// Small recordings for the tests of the evidence detector.
namespace self_awareness::core::evidence {

constexpr std::int64_t kMillisecond = 1000000;
constexpr std::int64_t kSecond = 1000 * kMillisecond;
constexpr std::int64_t kWindow = 100 * kMillisecond;
/// Time between two starts of a robot.
constexpr std::int64_t kStart = 1000 * kSecond;

/// Ids in the recordings below, and the event types they stand for.
constexpr EventId kA = 0;
constexpr EventId kB = 1;
constexpr EventId kC = 2;
inline const std::vector<EventType> kTypes{
    {"/a", "/x", "T"}, {"/b", "/y", "T"}, {"/c", "/z", "T"}};

using Events = std::vector<Event>;

/// Events of several components in the order of their stamps.
inline Events together(std::initializer_list<Events> parts) {
  Events events;
  for (const Events& part : parts) {
    events.insert(events.end(), part.begin(), part.end());
  }
  std::stable_sort(events.begin(), events.end(),
                   [](const Event& a, const Event& b) { return a.stamp < b.stamp; });
  return events;
}

/// A timer from `start` to `end` [ns].
inline Events timer(EventId id, std::int64_t start, std::int64_t end, std::int64_t period) {
  Events events;
  for (std::int64_t stamp = start; stamp < end; stamp += period) {
    events.push_back({stamp, id});
  }
  return events;
}

/// Events at random, with a mean gap of `gap` [ns], none shorter than a quarter of it.
inline Events irregular(EventId id, std::int64_t start, std::int64_t end, std::int64_t gap,
                        unsigned seed) {
  std::mt19937 random(seed);
  std::exponential_distribution<double> wait(1 / (0.75 * static_cast<double>(gap)));
  Events events;
  for (std::int64_t stamp = start; stamp < end;
       stamp += gap / 4 + static_cast<std::int64_t>(wait(random))) {
    events.push_back({stamp, id});
  }
  return events;
}

/// Answers to every one of other events, after a delay [ns].
inline Events answers(EventId id, const Events& asked, std::int64_t delay) {
  Events events;
  for (const Event& event : asked) {
    events.push_back({event.stamp + delay, id});
  }
  return events;
}

/// A comes at random, about every 200 ms, and B so much after it [ns].
inline Events followed(unsigned seed, std::int64_t length = 100 * kSecond,
                       std::int64_t delay = 20 * kMillisecond) {
  const Events asked = irregular(kA, 0, length, 200 * kMillisecond, seed);
  return together({asked, answers(kB, asked, delay)});
}

/// A source of messages with stamps, numbers, a size and content of their own.
struct Source {
  std::int64_t period = 100 * kMillisecond;
  double age = 0.02;         ///< of the stamps [s]
  std::uint64_t size = 800;  ///< [bytes]
  double spread = 0;         ///< by so many octaves sizes vary, up and down
  bool repeats = false;      ///< every message has the content of the one before
  double lost = 0;           ///< share of the messages
};

/// Its messages from `start` to `end` [ns].
inline Events messages(EventId id, std::int64_t start, std::int64_t end, const Source& source,
                       unsigned seed = 0) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::bernoulli_distribution lost(source.lost);
  Events events;
  for (std::int64_t stamp = start; stamp < end; stamp += source.period) {
    Attributes attributes;
    attributes.age = ageClass(toNanoseconds(source.age * (1 + 0.2 * uniform(random))));
    attributes.size = sizeClass(static_cast<std::uint64_t>(
        static_cast<double>(source.size) * std::exp2(source.spread * uniform(random))));
    attributes.step = lost(random) ? Attributes::Step::kLostOne : Attributes::Step::kNext;
    attributes.same = source.repeats;
    events.push_back({stamp, id, attributes});
  }
  return events;
}

/// So many event types that have nothing to do with each other, all at random.
inline Events atRandom(std::size_t types, std::int64_t start, std::int64_t length,
                       std::int64_t gap, unsigned seed) {
  Events events;
  for (EventId id = 0; id < types; ++id) {
    events = together({events, irregular(id, start, start + length, gap, seed + id)});
  }
  return events;
}

/// The events but for some.
template <typename Some>
Events without(Events events, Some some) {
  events.erase(std::remove_if(events.begin(), events.end(), some), events.end());
  return events;
}

/// A recording of another start of the robot: the same events later.
inline Events later(Events events, std::int64_t by = kStart) {
  for (Event& event : events) {
    event.stamp += by;
  }
  return events;
}

/// Adds all events to what takes them in one by one.
template <typename To>
void addAll(To& to, const Events& events) {
  for (const Event& event : events) {
    to.add(event);
  }
}

/// So many event types, each of a component of its own.
inline std::vector<EventType> numberedTypes(std::size_t number) {
  std::vector<EventType> types;
  for (std::size_t k = 0; k < number; ++k) {
    const std::string name = "/c" + std::to_string(k);
    types.push_back({name, name + "/out", "T"});
  }
  return types;
}

/// Counts of recordings with these event types.
inline Statistics countsOf(const std::vector<Events>& recordings,
                           const std::vector<EventType>& types) {
  Statistics statistics;
  for (const EventType& type : types) {
    statistics.intern(type);
  }
  Trainer trainer(statistics, kWindow);
  for (const Events& events : recordings) {
    trainer.startRecording();
    addAll(trainer, events);
  }
  trainer.finish();
  return statistics;
}

/// Counts of recordings, with the first so many of kTypes.
inline Statistics countsOf(const std::vector<Events>& recordings,
                           std::size_t types = kTypes.size()) {
  return countsOf(recordings,
                  {kTypes.begin(), kTypes.begin() + static_cast<std::ptrdiff_t>(types)});
}

/// Counts of a start of the robot, with its number.
inline Statistics startOf(const Events& events, std::int64_t number,
                          std::size_t types = kTypes.size()) {
  return countsOf({later(events, number * kStart)}, types);
}

/// What is watched of two halves, though few gaps tell little of a pace.
inline Watched watchAll(const Statistics& first, const Statistics& second, Tuning tuning = {}) {
  tuning.least_told = tuning.least_sum;
  return watch(first, second, {}, tuning);
}

/// Partners of an event type.
inline Partners partnersOf(std::initializer_list<Partner> all) {
  Partners partners;
  for (const Partner& partner : all) {
    partners.append(partner);
  }
  return partners;
}

/// Names of the channels.
constexpr const char* kOverdue = "overdue";
constexpr const char* kSlower = "slower";
constexpr const char* kFaster = "faster";
constexpr const char* kPairs = "pairs";
constexpr const char* kDeadlines = "deadlines";
constexpr const char* kCompany = "company";
constexpr const char* kAge = "age";
constexpr const char* kLost = "lost";
constexpr const char* kSize = "size";
constexpr const char* kFrozen = "frozen";

/// What a channel watches of one event type, or of two.
inline Track trackOf(const std::string& channel, EventId to, EventId from) {
  return {channelNamed(channel), to, from};
}

/// Index of a track; the number of tracks if it is not watched.
inline std::size_t indexOf(const std::vector<Track>& tracks, const std::string& channel,
                           EventId to, EventId from) {
  return static_cast<std::size_t>(std::find_if(tracks.begin(), tracks.end(),
                                               [&](const Track& track) {
                                                 return channelName(track) == channel &&
                                                        track.to == to && track.from == from;
                                               }) -
                                  tracks.begin());
}

inline bool isWatched(const std::vector<Track>& tracks, const std::string& channel, EventId to,
                      EventId from) {
  return indexOf(tracks, channel, to, from) < tracks.size();
}

}  // namespace self_awareness::core::evidence
