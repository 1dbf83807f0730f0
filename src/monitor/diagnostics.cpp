#include "diagnostics.h"

#include <algorithm>
#include <cmath>

#include "ros/verdict/verdict_message.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/stream/vocabulary.h"

namespace self_awareness {
namespace {

using diagnostic_msgs::DiagnosticStatus;

std::string number(double value) {
  if (std::isnan(value)) {
    return "none";
  }
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

}  // namespace

Diagnostics::Diagnostics(const ros::NodeHandle& node_handle,
                         const ros::NodeHandle& private_node_handle, const std::string& name,
                         const std::string& hardware_id, bool component_statuses)
    : component_statuses_(component_statuses), updater_(node_handle, private_node_handle, name) {
  updater_.setHardwareID(hardware_id);
  updater_.add("communication", [this](Status& status) { communication(status); });
  updater_.add("monitor", [this](Status& status) { monitor(status); });
}

void Diagnostics::publish(const MonitorState& state) {
  state_ = state;
  updateComponents();
  updater_.force_update();
}

// The components change with the model only, so most of the time there is nothing to do.
void Diagnostics::updateComponents() {
  std::vector<std::string> names;
  if (component_statuses_) {
    for (const auto& [name, component] : state_.heard.components) {
      names.push_back(name);
    }
  }
  for (const std::string& name : components_) {
    if (!std::binary_search(names.begin(), names.end(), name)) {
      updater_.removeByName(name);
    }
  }
  for (const std::string& name : names) {
    if (!std::binary_search(components_.begin(), components_.end(), name)) {
      updater_.add(name, [this, name](Status& status) { component(name, status); });
    }
  }
  components_ = names;
}

void Diagnostics::communication(Status& status) const {
  const self_awareness::SelfAwareness& last = state_.last;
  if (!state_.model_error.empty()) {
    status.summary(DiagnosticStatus::ERROR, "no model: " + state_.model_error);
  } else if (!state_.started) {
    status.summary(DiagnosticStatus::OK, "waiting for the first message");
  } else {
    // Not an alarm, but an operator who relies on one must know that none can come.
    const std::uint8_t uncalibrated = DiagnosticStatus::WARN;
    status.summary(state_.calibrated ? last.level : uncalibrated, last.message);
    const std::size_t heard = state_.heard.known_types + state_.heard.unknown_types;
    if (!last.settling && static_cast<double>(state_.heard.known_types) <
                              core::kLeastKnown * static_cast<double>(heard)) {
      status.mergeSummary(DiagnosticStatus::WARN,
                          "the model knows " + std::to_string(state_.heard.known_types) +
                              " of the " + std::to_string(heard) +
                              " event types that were heard: is it of this robot?");
    }
    status.add("score", number(last.score));
    status.add("threshold", number(last.threshold));
    status.add("events in the window", last.events);
    status.add("unknown events in the window", last.unknown_events);
    if (last.level != DiagnosticStatus::OK) {
      status.add("evidence", last.evidence);
      status.add("for [s]", number(state_.level_for));
    }
    for (std::size_t i = 0; i < last.suspects.size(); ++i) {
      status.add("suspect " + std::to_string(i + 1), ros1::describe(last.suspects[i]));
    }
  }
  status.add("model", state_.model);
}

void Diagnostics::component(const std::string& name, Status& status) const {
  const ros1::HeardReport::Component& component = state_.heard.components.at(name);
  status.summary(DiagnosticStatus::OK, component.last_heard ? "heard" : "not heard yet");
  const std::vector<self_awareness::Suspect>& suspects = state_.last.suspects;
  for (std::size_t i = 0; i < suspects.size() && state_.last.level != DiagnosticStatus::OK; ++i) {
    if (core::componentOf(suspects[i].source, suspects[i].scope) == name) {
      // The most likely one is to blame; the others may well be its victims.
      status.summary(i == 0 && !state_.busy && state_.last.level == DiagnosticStatus::ERROR
                         ? DiagnosticStatus::ERROR
                         : DiagnosticStatus::WARN,
                     ros1::describeOnScope(suspects[i]));
      break;
    }
  }
  if (component.last_heard) {
    status.add("last heard [s ago]", number(*component.last_heard));
  }
  status.add("events a second", number(component.rate));
}

void Diagnostics::monitor(Status& status) const {
  status.summary(DiagnosticStatus::OK, "listening");
  if (!state_.master_answers) {
    status.mergeSummary(DiagnosticStatus::WARN, "the master does not answer");
  }
  if (state_.heard.newly_dropped > 0) {
    status.mergeSummary(DiagnosticStatus::WARN,
                        std::to_string(state_.heard.newly_dropped) + " messages were dropped");
  }
  status.add("events a second", number(state_.heard.rate));
  status.add("dropped messages", state_.heard.dropped);
  status.add("subscriptions", state_.subscriptions);
  status.add("publishers heard", state_.connections);
  status.add("share of a core spent", number(state_.heard.cpu_share));
  status.add("times the clock was set", state_.heard.clock_steps);
}

}  // namespace self_awareness
