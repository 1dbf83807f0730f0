#include "heard_tally.h"

#include <algorithm>
#include <utility>

namespace self_awareness::ros1 {

// Two reports may come one right after the other, when the level changes.
constexpr double kShortestPeriod = 1e-3;  // [s]
// Rates of topics are of so long at least, and of twice as long at most [ns].
constexpr std::int64_t kOfRates = 10 * core::kNanosecondsPerSecond;

void HeardTally::setTypes(const std::vector<core::EventType>& types) {
  components_.clear();
  topics_.clear();
  topic_of_.clear();
  before_ = since_ = reported_at_.steady;
  heard_types_.clear();
  known_types_ = unknown_types_ = 0;
  std::map<std::string, std::size_t> indices;
  std::map<std::pair<std::size_t, std::string>, std::size_t> topics;
  for (const core::EventType& type : types) {
    const std::string name = core::componentOf(type.source, type.scope);
    const auto [index, is_new] = indices.try_emplace(name, components_.size());
    if (is_new) {
      components_.push_back({name, std::nullopt, 0});
    }
    const auto [topic, is_first] = topics.try_emplace({index->second, type.scope}, topics_.size());
    if (is_first) {
      topics_.push_back({type.scope, index->second, 0, 0});
    }
    topic_of_.push_back(topic->second);
  }
}

void HeardTally::add(const core::Event& event) {
  ++events_;
  const bool known = event.id < topic_of_.size();
  if (event.id >= heard_types_.size()) {
    heard_types_.resize(event.id + 1, false);
  }
  if (!heard_types_[event.id]) {
    heard_types_[event.id] = true;
    ++(known ? known_types_ : unknown_types_);
  }
  if (known) {
    Topic& topic = topics_[topic_of_[event.id]];
    ++topic.events;
    Component& component = components_[topic.component];
    component.last_heard = event.stamp;
    ++component.events;
  }
}

void HeardTally::onClockStep() {
  ++clock_steps_;
  for (Component& component : components_) {
    component.last_heard.reset();
  }
}

double HeardTally::sinceReport(std::int64_t now) const {
  return core::toSeconds(now - reported_at_.steady);
}

HeardReport HeardTally::report(const Moment& now, std::uint64_t dropped) {
  const double period = std::max(sinceReport(now.steady), kShortestPeriod);
  HeardReport report;
  for (Component& component : components_) {
    HeardReport::Component& reported = report.components[component.name];
    if (component.last_heard) {
      reported.last_heard = core::toSeconds(now.ros - *component.last_heard);
    }
    reported.rate = static_cast<double>(component.events) / period;
    component.events = 0;
  }
  const double of_rates = std::max(core::toSeconds(now.steady - before_), kShortestPeriod);
  const bool next = now.steady - since_ >= kOfRates;
  for (Topic& topic : topics_) {
    report.components[components_[topic.component].name].rates[topic.name] =
        static_cast<double>(topic.before + topic.events) / of_rates;
    if (next) {
      topic.before = std::exchange(topic.events, 0);
    }
  }
  if (next) {
    before_ = std::exchange(since_, now.steady);
  }
  report.rate = static_cast<double>(events_) / period;
  report.cpu_share = core::toSeconds(now.cpu - reported_at_.cpu) / period;
  report.dropped = dropped;
  report.known_types = known_types_;
  report.unknown_types = unknown_types_;
  report.newly_dropped = dropped - reported_drops_;
  report.clock_steps = clock_steps_;
  events_ = 0;
  reported_drops_ = dropped;
  reported_at_ = now;
  return report;
}

}  // namespace self_awareness::ros1
