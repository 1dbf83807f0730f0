#include <ros/console.h>
#include <ros/this_node.h>

#include <set>
#include <string>

#include "monitor.h"
#include "ros/now.h"
#include "ros/text.h"
#include "self_awareness/core/verdict/alarm.h"

namespace self_awareness {

void Monitor::onMasterRestart(std::int64_t /*now*/) {
  kept_logs_.onRobotStart(wallNow());
  drift_.onRobotStart(wallNow());
}

void Monitor::onGraph(const ros1::Graph& graph) {
  session_->addEdges(graph, ros::this_node::getName());
  const std::int64_t now = live_->now();
  auto id = static_cast<std::uint64_t>(now);  // one for each: by it, incidents are told apart
  for (const std::string& source :
       restarts_.see(graph.addresses, *session_->encoder(), now, ros1::utc(wallNow()))) {
    session_->onRestarted(source);
    const std::string words = restarts_.inWords(source, now);
    const std::string muted = mutes_.ofComponent(source);
    if (restarts_.count(source, now) == Restarts::kMany) {
      if (muted.empty()) {
        ROS_WARN("%s %s", source.c_str(), words.c_str());
      } else {
        ROS_INFO("muted (%s): %s %s", muted.c_str(), source.c_str(), words.c_str());
      }
    }
    if (restarts_.count(source, now) >= Restarts::kMany && muted.empty() &&
        !announcer_.alarm().standing()) {
      core::Alarm near_miss;
      near_miss.id = id++;
      near_miss.begin = near_miss.end = now;
      near_miss.over = true;
      near_miss.culprit = source;
      near_miss.reason = words;
      incidents_.add(near_miss, session_->graph(), "", parameters_.model);
      incidents_publisher_.publish(incidents_.incidents());
    }
  }
}

void Monitor::onFirstOfRestarted(const core::Event& event) {
  const std::string& source = session_->types()[event.id].source;
  restarts_.onHeard(source, event.stamp);
  // Who is started again and again is not excused; and by the paper's score, which is that of all,
  // one node that starts would excuse the whole robot.
  if (parameters_.method == MonitorParameters::Method::kEvidence &&
      restarts_.count(source, event.stamp) <= Restarts::kMany) {
    session_->detector().onMissed({event.id}, event.stamp);
  }
}

void Monitor::followRestarts(std::int64_t now) {
  std::set<std::string> abnormal;
  for (const self_awareness::Suspect& suspect : announcer_.alarm().message().suspects) {
    abnormal.insert(suspect.component);
  }
  for (const std::string& line : restarts_.advance(now, abnormal)) {
    ROS_INFO("%s", line.c_str());
  }
}

}  // namespace self_awareness
