#include "reports.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <utility>

#include "node/live_source.h"
#include "node/node_status.h"
#include "parameters.h"
#include "ros/verdict/components.h"
#include "self_awareness/Components.h"
#include "self_awareness/ros/graph.h"
#include "self_awareness/ros/ros_time.h"
#include "session.h"

namespace self_awareness {

// Nothing heard since the start for longer is told [ns of steady time].
constexpr std::int64_t kNothingHeard = 10 * core::kNanosecondsPerSecond;

Reports::Reports(Host& host, ros::NodeHandle& node_handle, ros::NodeHandle& private_node_handle,
                 const std::string& name)
    : host_(host),
      name_(name),
      round_(host.parameters().diagnostic_bytes),
      diagnostics_publisher_(
          node_handle.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 1)),
      components_publisher_(
          private_node_handle.advertise<self_awareness::Components>("components", 1, true)),
      heard_(momentNow()),
      published_at_(ros1::steadyNow()) {}

ros1::HeardTally::Moment Reports::momentNow() {
  timespec cpu{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
  return {ros1::rosNow(), ros1::steadyNow(),
          cpu.tv_sec * core::kNanosecondsPerSecond + cpu.tv_nsec};
}

void Reports::onStart(const Session& session, const std::string& /*path*/) {
  model_error_.clear();
  mode_.clear();
  heard_.setTypes(session.types());
  started_at_ = ros1::steadyNow();
}

void Reports::onCut(Cut why) {
  if (why == Cut::kClockSet) {
    heard_.onClockStep();
  }
}

void Reports::onEvent(const core::Event& event, const core::Vocabulary& vocabulary) {
  if (vocabulary.isMessage(event.id)) {
    heard_.add(event);
  }
}

void Reports::onVerdict(core::Verdict& verdict, ros1::Circumstances& /*circumstances*/) {
  mode_ = verdict.mode;
}

void Reports::onPause(std::int64_t pause) {
  longest_pause_ = std::max(longest_pause_, pause);
}

void Reports::publish(const std::vector<Part*>& parts) {
  now_ = momentNow();
  now_.ros = host_.live().now();
  MonitorState state;
  for (Part* part : parts) {
    part->onReport(state);
  }
  if (host_.session() != nullptr && now_.steady - components_at_ >= core::kNanosecondsPerSecond) {
    components_at_ = now_.steady;
    self_awareness::Components components = ros1::toComponents(
        state.communication, host_.live().graph().get(), *host_.session()->encoder());
    components.header.stamp = ros1::toRosTime(now_.ros);
    components.mutes = state.mutes;
    components_publisher_.publish(components);
  }
  publishDiagnostics(state);
}

void Reports::publishDiagnostics(MonitorState& state) {
  const double elapsed = core::toSeconds(now_.steady - std::exchange(published_at_, now_.steady));
  state.communication.lists = lists_.next(allLists(state), elapsed);
  const std::string& hardware_id = host_.parameters().hardware_id;
  ros1::DiagnosticStatuses statuses(name_, hardware_id, state.ros_now);
  diagnostic_updater::DiagnosticStatusWrapper communication;
  ros1::tellCommunication(state.communication, communication);
  if (state.communication.started && clockStands(state.clock_stands_still_for)) {
    communication.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN,
                               "not judged any more: ROS time stands still");
  }
  statuses.add("communication", communication);
  diagnostic_updater::DiagnosticStatusWrapper monitor;
  tellMonitor(state, monitor);
  statuses.add("monitor", monitor);
  if (host_.parameters().source_diagnostics) {
    ros1::DiagnosticStatuses of_components(name_, hardware_id, state.ros_now);
    ros1::addComponents(state.communication, of_components);
    ros1::addChosen(of_components, round_, elapsed, statuses);
  }
  diagnostics_publisher_.publish(statuses.message());
}

void Reports::onReport(MonitorState& state) {
  const LiveSource& live = host_.live();
  const Discovery::State discovered = live.discovery().state();
  state.communication.model = host_.parameters().model;
  state.communication.model_error = model_error_;
  state.communication.take(host_.alarm(), heard_.report(now_, live.events().dropped()), now_.ros);
  if (Session* session = host_.session()) {
    session->tell(state.communication);
    state.communication.shares = session->takeShares();
    state.communication.mode = mode_;
    state.communication.nothing_heard =
        nothingHeard(state.communication.heard, now_.steady - started_at_);
    state.full_of_unknown = session->full();
    state.mode = session->mode(now_.ros);
  }
  state.subscriptions = discovered.subscriptions;
  state.connections = live.events().connections();
  state.left_out_topics = discovered.left_out;
  state.ros_now = now_.ros;
  state.clock_stands_still_for = live.clock().standsStillFor();
  state.clock_rivals = live.clockRivals();
  state.longest_pause = core::toSeconds(std::exchange(longest_pause_, 0));
  state.master_answers = discovered.master_answers;
}

std::string Reports::nothingHeard(const ros1::HeardReport& heard, std::int64_t waited) const {
  const LiveSource& live = host_.live();
  if (heard.known_types + heard.unknown_types > 0 || waited < kNothingHeard ||
      clockStands(live.clock().standsStillFor())) {
    return "";
  }
  return "nothing has been heard for " + ros1::number(std::floor(core::toSeconds(waited))) +
         " s: " +
         (live.graph() ? ros1::whyNothingIsHeard(*live.graph(), *host_.session()->encoder(), false)
                       : "the master has not said who publishes");
}

}  // namespace self_awareness
