#include "self_awareness/ros/live/arrivals.h"

#include <algorithm>
#include <iterator>

namespace self_awareness::ros1 {

// So long after that, a connection of no content is forgotten: it may be closed [ns].
constexpr std::int64_t kForgotten = 10 * core::kNanosecondsPerSecond;

Arrivals::Arrivals(std::uint32_t queue_size, std::function<void()> wake)
    : queue_size_(queue_size), wake_(std::move(wake)) {}

void Arrivals::add(Arrival arrival) {
  bool wake = false;
  {
    const auto waiting = waiting_.lock();
    ++waiting->arrived;
    arrival.size = arrival.message->size();
    const auto no_content = waiting->no_content_until.find(arrival.header.get());
    if (no_content != waiting->no_content_until.end() && arrival.steady < no_content->second) {
      arrival.message.reset();
    }
    const std::size_t bytes = arrival.message ? arrival.size : 0;
    std::uint32_t& of_connection = waiting->of_connection[arrival.header.get()];
    // A single message is taken however long it is.
    const bool too_long = waiting->bytes > 0 && waiting->bytes + bytes > kMostBytes;
    if (of_connection >= queue_size_ || too_long) {
      drop(*waiting, arrival);
      return;
    }
    waiting->bytes += bytes;
    // Half: there is room for what comes until it is taken.
    wake = ++of_connection == queue_size_ / 2 + 1;
    const std::int64_t interval = core::floorToGrid(arrival.stamp, waiting->interval);
    wake = wake || interval != waiting->last_interval;
    waiting->last_interval = interval;
    waiting->arrivals.push_back(std::move(arrival));
  }
  if (wake) {
    wake_();
  }
}

void Arrivals::drop(Waiting& waiting, const Arrival& arrival) {
  ++waiting.dropped;
  if (std::none_of(waiting.dropped_of.begin(), waiting.dropped_of.end(),
                   [&](const Dropped& known) { return known.header == arrival.header; })) {
    waiting.dropped_of.push_back({arrival.topic, arrival.header});
  }
}

void Arrivals::dropContent(const ros::M_string* header, std::int64_t until) {
  const auto waiting = waiting_.lock();
  auto& all = waiting->no_content_until;
  for (auto each = all.begin(); each != all.end();) {
    each = each->second < until - kForgotten ? all.erase(each) : std::next(each);
  }
  all[header] = until;
}

void Arrivals::setInterval(std::int64_t interval) {
  waiting_.lock()->interval = interval;
}

std::vector<Arrivals::Dropped> Arrivals::take(std::vector<Arrival>& arrivals) {
  arrivals.clear();
  const auto waiting = waiting_.lock();
  arrivals.swap(waiting->arrivals);
  waiting->of_connection.clear();
  waiting->bytes = 0;
  return std::exchange(waiting->dropped_of, {});
}

}  // namespace self_awareness::ros1
