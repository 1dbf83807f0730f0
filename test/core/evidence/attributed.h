#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "recordings.h"

/// Recordings of messages with attributes, for the tests of what is counted of them and judged.
namespace self_awareness::core::evidence {

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

}  // namespace self_awareness::core::evidence
