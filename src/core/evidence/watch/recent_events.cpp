#include "core/evidence/watch/recent_events.h"

#include <algorithm>

namespace self_awareness::core::evidence {

std::uint64_t RecentEvents::before(std::uint64_t number) const {
  const std::uint32_t distance = events_[number % kMost].before >> 1U;
  return distance > 0 && isRemembered(number - distance) ? number - distance : 0;
}

std::vector<RecentEvents::Remembered> RecentEvents::of(EventId a, EventId b) const {
  std::vector<Remembered> events;
  std::uint64_t of_a = isRemembered(last_[a]) ? last_[a] : 0;
  std::uint64_t of_b = a != b && isRemembered(last_[b]) ? last_[b] : 0;
  while (of_a > 0 || of_b > 0) {
    std::uint64_t& next = of_a > of_b ? of_a : of_b;
    const Entry& event = events_[next % kMost];
    events.push_back({event.stamp, event.id, (event.before & 1U) != 0});
    next = before(next);
  }
  std::reverse(events.begin(), events.end());
  return events;
}

std::size_t RecentEvents::since(EventId id, EventId other) const {
  std::size_t number = 0;
  for (std::uint64_t event = isRemembered(last_[id]) ? last_[id] : 0; event > last_[other];
       event = before(event)) {
    ++number;
  }
  return number;
}

}  // namespace self_awareness::core::evidence
