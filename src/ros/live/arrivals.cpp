#include "self_awareness/ros/live/arrivals.h"

#include <algorithm>

namespace self_awareness::ros1 {

Arrivals::Arrivals(std::uint32_t queue_size, std::function<void()> wake)
    : queue_size_(queue_size), wake_(std::move(wake)) {}

std::shared_ptr<Arrival::Topic> Arrivals::addTopic(const std::string& name) {
  const auto waiting = waiting_.lock();
  const auto [topic, is_new] = waiting->topics.try_emplace(name, waiting->topics.size());
  if (is_new) {
    waiting->of_topic.push_back(0);
  }
  return std::make_shared<Arrival::Topic>(name, topic->second);
}

void Arrivals::add(Arrival arrival) {
  bool wake = false;
  {
    const auto waiting = waiting_.lock();
    std::uint32_t& of_topic = waiting->of_topic[arrival.topic->number];
    if (of_topic >= queue_size_) {
      ++waiting->dropped;
      return;
    }
    // Half: there is room for what comes until it is taken.
    wake = ++of_topic == queue_size_ / 2 + 1;
    const std::int64_t interval = core::floorToGrid(arrival.stamp, waiting->interval);
    wake = wake || interval != waiting->last_interval;
    waiting->last_interval = interval;
    waiting->arrivals.push_back(std::move(arrival));
  }
  if (wake) {
    wake_();
  }
}

void Arrivals::setInterval(std::int64_t interval) {
  waiting_.lock()->interval = interval;
}

void Arrivals::take(std::vector<Arrival>& arrivals) {
  arrivals.clear();
  const auto waiting = waiting_.lock();
  arrivals.swap(waiting->arrivals);
  std::fill(waiting->of_topic.begin(), waiting->of_topic.end(), 0);
}

}  // namespace self_awareness::ros1
