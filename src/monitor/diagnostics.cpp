#include "diagnostics.h"

#include <algorithm>

#include "clock_status.h"
#include "session.h"

namespace self_awareness {

using diagnostic_msgs::DiagnosticStatus;
using ros1::number;

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
    for (const auto& [name, component] : state_.communication.heard.components) {
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
      updater_.add(name, [this, name](Status& status) {
        ros1::tellComponent(state_.communication, name, status);
      });
    }
  }
  components_ = names;
}

void Diagnostics::communication(Status& status) const {
  ros1::tellCommunication(state_.communication, status);
  if (state_.communication.started && clockStands(state_.clock_stands_still_for)) {
    status.mergeSummary(DiagnosticStatus::WARN, "not judged any more: ROS time stands still");
  }
}

void Diagnostics::monitor(Status& status) const {
  const ros1::HeardReport& heard = state_.communication.heard;
  status.summary(DiagnosticStatus::OK, "listening");
  if (!state_.master_answers) {
    status.mergeSummary(DiagnosticStatus::WARN, "the master does not answer");
  }
  if (heard.newly_dropped > 0) {
    status.mergeSummary(DiagnosticStatus::WARN,
                        "overloaded: " + std::to_string(heard.newly_dropped) +
                            " messages were dropped; who sent them is judged later");
  }
  if (state_.longest_pause > 0) {
    status.mergeSummary(DiagnosticStatus::WARN, "overloaded: this program stood still for " +
                                                    number(state_.longest_pause) +
                                                    " s; all are judged later");
  }
  tellClock(state_.clock_stands_still_for, state_.ros_now, status);
  if (state_.full_of_unknown) {
    status.mergeSummary(DiagnosticStatus::WARN,
                        "more than " + std::to_string(Session::kMostUnknownTypes) +
                            " event types that the model does not know: further ones are not "
                            "told apart");
  }
  if (state_.left_out_topics > 0) {
    status.mergeSummary(DiagnosticStatus::WARN, std::to_string(state_.left_out_topics) +
                                                    " topics are left out: there are too many");
  }
  status.add("events a second", number(heard.rate));
  status.add("dropped messages", heard.dropped);
  status.add("subscriptions", state_.subscriptions);
  status.add("event types that the model does not know", heard.unknown_types);
  status.add("publishers heard", state_.connections);
  status.add("share of a core spent", number(heard.cpu_share));
  status.add("times the clock was set", heard.clock_steps);
  if (state_.recorder) {
    recorder(*state_.recorder, status);
  }
}

void Diagnostics::recorder(const FlightRecorder::Report& report, Status& status) {
  if (!report.files.error.empty()) {
    status.mergeSummary(DiagnosticStatus::WARN,
                        "the flight recorder cannot write: " + report.files.error);
  }
  status.add("recorded [s]", number(report.seconds));
  status.add("memory of the recorder [MB]", number(static_cast<double>(report.bytes) * 1e-6));
  status.add("files of the recorder", report.files.written);
  status.add("files given up", report.files.given_up);
  status.add("last file", report.files.last_written);
}

}  // namespace self_awareness
