#include "restart_watch.h"

#include <ros/console.h>

#include <set>
#include <string>

#include "diagnostics.h"
#include "node/live_source.h"
#include "parameters.h"
#include "ros/now.h"
#include "ros/text.h"
#include "session.h"

namespace self_awareness {

RestartWatch::RestartWatch(Host& host)
    : host_(host), restarts_(host.parameters().detector.settle_time) {}

void RestartWatch::onGraph(const ros1::Graph& graph) {
  core::Alarm near_miss;
  near_miss.begin = near_miss.end = host_.live().now();
  near_miss.id = static_cast<std::uint64_t>(near_miss.end);
  for (const std::string& source : restarts_.see(graph.addresses, *host_.session()->encoder(),
                                                 near_miss.end, ros1::utc(wallNow()))) {
    onRestarted(source, near_miss);
    ++near_miss.id;  // one for each: by it, incidents are told apart
  }
}

void RestartWatch::onRestarted(const std::string& source, core::Alarm near_miss) {
  host_.session()->onRestarted(source);
  const std::size_t count = restarts_.count(source, near_miss.end);
  if (count < Restarts::kMany) {
    return;
  }
  const std::string words = restarts_.inWords(source, near_miss.end);
  const std::string muted = host_.mutedBy(source);
  if (count == Restarts::kMany && muted.empty()) {
    ROS_WARN("%s %s", source.c_str(), words.c_str());
  } else if (count == Restarts::kMany) {
    ROS_INFO("muted (%s): %s %s", muted.c_str(), source.c_str(), words.c_str());
  }
  if (muted.empty() && !host_.alarm().standing()) {
    near_miss.over = true;
    near_miss.culprit = source;
    near_miss.reason = words;
    host_.nearMiss(near_miss);
  }
}

void RestartWatch::onFirst(const core::Event& event) {
  const std::string& source = host_.session()->types()[event.id].source;
  restarts_.onHeard(source, event.stamp);
  // By the paper's score, which is that of all, one node that starts would excuse the whole robot.
  if (host_.parameters().method == MonitorParameters::Method::kEvidence &&
      restarts_.count(source, event.stamp) <= Restarts::kMany) {
    host_.session()->detector().onMissed({event.id}, event.stamp);
  }
}

void RestartWatch::onTick(const Moment& now) {
  std::set<std::string> abnormal;
  for (const self_awareness::Suspect& suspect : host_.alarm().message().suspects) {
    abnormal.insert(suspect.component);
  }
  for (const std::string& line : restarts_.advance(now.ros, abnormal)) {
    ROS_INFO("%s", line.c_str());
  }
}

void RestartWatch::onCut(Cut why) {
  if (why == Cut::kClockSet) {
    restarts_.onClockSet();
  }
}

void RestartWatch::onReport(MonitorState& state) {
  for (const core::evidence::Coverage& each : state.communication.coverage) {
    const std::size_t count = restarts_.count(each.component, state.ros_now);
    if (count > 0) {
      state.communication.restarts[each.component] = {
          restarts_.inWords(each.component, state.ros_now), count >= Restarts::kMany};
    }
  }
}

}  // namespace self_awareness
