#include "restart_watch.h"

#include <ros/console.h>

#include <algorithm>

#include "diagnostics.h"
#include "node/live_source.h"
#include "parameters.h"
#include "ros/text.h"
#include "self_awareness/ros/ros_time.h"
#include "self_awareness/ros/stable_name.h"
#include "session.h"

namespace self_awareness {

constexpr std::size_t kMostCounted = 100;
constexpr std::int64_t kMinute = 60'000'000'000;

std::vector<std::string> Restarts::see(const std::map<std::string, std::string>& addresses,
                                       const ros1::Encoder& encoder, std::int64_t now,
                                       const std::string& when) {
  std::set<std::string> restarted;
  for (const auto& [node, address] : addresses) {
    if (address.empty() || !encoder.includesSource(ros1::stableName(node))) {
      continue;
    }
    const auto known = addresses_.find(node);
    if (known == addresses_.end()) {
      if (addresses_.size() < kMostNodes) {
        addresses_[node] = address;
      }
    } else if (known->second != address) {
      known->second = address;
      restarted.insert(encoder.sourceOf(node));
    }
  }
  for (const std::string& name : restarted) {
    Source& source = sources_[name];
    source.restarts.push_back(now);
    while (source.restarts.size() > kMostCounted || source.restarts.front() < now - kSpan) {
      source.restarts.pop_front();
    }
    source.when = when;
    source.waits = true;
    source.heard.reset();
  }
  return {restarted.begin(), restarted.end()};
}

void Restarts::onHeard(const std::string& source, std::int64_t now) {
  const auto known = sources_.find(source);
  if (known != sources_.end() && known->second.waits && !known->second.heard) {
    known->second.heard = now;
  }
}

std::vector<std::string> Restarts::advance(std::int64_t now,
                                           const std::set<std::string>& abnormal) {
  std::vector<std::string> lines;
  for (auto& [name, source] : sources_) {
    if (source.waits && source.heard && now >= *source.heard + settle_time_ &&
        abnormal.count(name) == 0) {
      source.waits = false;
      const std::size_t times = count(name, now);
      lines.push_back(name + " restarted at " + source.when + ", back as usual" +
                      (times > 1 ? "; " + inWords(name, now) : ""));
    }
  }
  return lines;
}

void Restarts::onClockSet() {
  for (auto& [name, source] : sources_) {
    source.restarts.clear();
    source.waits = false;
  }
}

std::size_t Restarts::count(const std::string& source, std::int64_t now) const {
  const auto known = sources_.find(source);
  return known == sources_.end()
             ? 0
             : static_cast<std::size_t>(
                   std::count_if(known->second.restarts.begin(), known->second.restarts.end(),
                                 [&](std::int64_t at) { return at >= now - kSpan; }));
}

std::string Restarts::inWords(const std::string& source, std::int64_t now) const {
  const std::size_t times = count(source, now);
  return times == 0 ? ""
                    : "restarted " + std::to_string(times) + (times == 1 ? " time" : " times") +
                          " in " + std::to_string(kSpan / kMinute) + " min";
}

RestartWatch::RestartWatch(Host& host)
    : host_(host), restarts_(host.parameters().detector.settle_time) {}

void RestartWatch::onGraph(const ros1::Graph& graph) {
  core::Alarm near_miss;
  near_miss.begin = near_miss.end = host_.live().now();
  near_miss.id = static_cast<std::uint64_t>(near_miss.end);
  for (const std::string& source : restarts_.see(graph.addresses, *host_.session()->encoder(),
                                                 near_miss.end, ros1::utc(ros1::wallNow()))) {
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
