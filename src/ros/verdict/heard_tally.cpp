#include "heard_tally.h"

#include <algorithm>

namespace self_awareness::ros1 {
namespace {

// Two reports may come one right after the other, when the level changes.
constexpr double kShortestPeriod = 1e-3;  // [s]

}  // namespace

void HeardTally::setTypes(const std::vector<core::EventType>& types) {
  components_.clear();
  component_of_.clear();
  heard_types_.clear();
  known_types_ = unknown_types_ = 0;
  std::map<std::string, std::size_t> indices;
  for (const core::EventType& type : types) {
    const std::string name = core::componentOf(type.source, type.scope);
    const auto [index, is_new] = indices.try_emplace(name, components_.size());
    if (is_new) {
      components_.push_back({name, std::nullopt, 0});
    }
    component_of_.push_back(index->second);
  }
}

void HeardTally::add(const core::Event& event) {
  ++events_;
  const bool known = event.id < component_of_.size();
  if (event.id >= heard_types_.size()) {
    heard_types_.resize(event.id + 1, false);
  }
  if (!heard_types_[event.id]) {
    heard_types_[event.id] = true;
    ++(known ? known_types_ : unknown_types_);
  }
  if (known) {
    Component& component = components_[component_of_[event.id]];
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
