#include "mute_calls.h"

#include <ros/console.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "diagnostics.h"
#include "ros/text.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/ros_time.h"
#include "session.h"

namespace self_awareness {
namespace {

std::string what(const core::Mute& mute) {
  if (mute.mutesAll()) {
    return "maintenance";
  }
  std::string words = mute.component;
  if (!mute.topic.empty()) {
    words += (words.empty() ? "" : " on ") + mute.topic;
  }
  if (mute.kind) {
    words += (words.empty() ? "" : " ") + ("(" + core::toString(*mute.kind) + ")");
  }
  return words;
}

/// When it ends, by the clock on the wall.
std::string until(const core::Mute& mute) {
  return "until " + ros1::utc(ros1::wallNow() + mute.until - ros1::steadyNow()) +
         (mute.until_over ? " or it is over" : "");
}

std::string counts(const core::Mute& mute) {
  return std::to_string(mute.alarms) + " alarms and " + std::to_string(mute.suspicions) +
         " suspicions were muted";
}

/// Empty: there is none.
std::string reasonOf(const core::Mute* mute) {
  return mute == nullptr ? "" : what(*mute) + " " + until(*mute) + ", by " + mute->by;
}

std::string pattern(const std::string& name, const char* field) {
  if (name.size() > ros1::kLongestName || !ros1::isPrintable(name)) {
    throw std::invalid_argument(std::string(field) + ": not a name: too long, or not printable");
  }
  return name;
}

/// @throw std::invalid_argument says what is wrong
core::Mute muteOf(const Mute::Request& request) {
  core::Mute mute;
  mute.component = pattern(request.component, "component");
  mute.topic = pattern(request.topic, "topic");
  if (!request.kind.empty()) {
    mute.kind = core::kindOf(request.kind);
    if (!mute.kind) {
      throw std::invalid_argument("kind: " + ros1::printable(request.kind, ros1::kLongestName) +
                                  " is not a kind; ~alarm shows the kind of what stands");
    }
  }
  if (mute.mutesAll()) {
    throw std::invalid_argument("name a component, a topic or a kind; a component '*' is all");
  }
  if (mute.component == "*" && mute.topic.empty() && !mute.kind) {
    mute.component.clear();
  }
  mute.until_over = request.until_over != 0U;
  return mute;
}

}  // namespace

std::vector<ros::ServiceServer> MuteCalls::advertise(ros::NodeHandle& private_node_handle) {
  return {private_node_handle.advertiseService("mute", &MuteCalls::onMute, this),
          private_node_handle.advertiseService("maintenance", &MuteCalls::onMaintenance, this)};
}

void MuteCalls::onTick(const Moment& now) {
  if (mutesAll()) {
    host_.notNormal("maintenance");
  }
  const std::vector<core::Mute> over = mutes_.advance(now.steady);
  for (const core::Mute& mute : over) {
    ROS_WARN("mute ended, since its time is over: %s; %s", what(mute).c_str(),
             counts(mute).c_str());
  }
  if (!over.empty()) {
    onChange();
  }
}

void MuteCalls::onChange() {
  if (mutesAll()) {
    host_.notNormal("maintenance");
  }
  if (host_.session() != nullptr) {
    if (onStanding(host_.alarm().standing())) {
      log(host_.alarm().message());
    }
    host_.report();
  }
}

void MuteCalls::onAlarm(const ros1::AlarmState& alarm) {
  onStanding(alarm.standing());
  log(alarm.message());
}

void MuteCalls::onReport(MonitorState& state) {
  state.communication.muted = ofWhatStands();
  for (const core::Mute& mute : mutes_.list()) {
    state.mutes.push_back(what(mute) + " " + until(mute) + ", by " + mute.by + "; " +
                          counts(mute));
  }
  for (auto& [component, restarts] : state.communication.restarts) {
    restarts.second = restarts.second && ofComponent(component).empty();
  }
}

bool MuteCalls::onStanding(const std::optional<core::Alarm>& standing) {
  const Session& session = *host_.session();
  for (const core::Mute& mute :
       mutes_.onStanding(standing, session.vocabulary(), session.graph())) {
    ROS_WARN("mute ended, since all is normal again: %s; %s", what(mute).c_str(),
             counts(mute).c_str());
  }
  const bool was_muted = std::exchange(muted_, mutes_.active() != nullptr);
  return standing && was_muted && !muted_;
}

void MuteCalls::log(const self_awareness::SelfAwareness& alarm) const {
  const std::string muted = ofWhatStands();
  if (!muted.empty()) {
    ROS_INFO("muted (%s): %s", muted.c_str(), alarm.message.c_str());
  } else if (alarm.level == self_awareness::SelfAwareness::ERROR) {
    ROS_ERROR("%s", alarm.message.c_str());
  } else if (alarm.level == self_awareness::SelfAwareness::WARN) {
    ROS_WARN("%s", alarm.message.c_str());
  } else {
    ROS_INFO("%s", alarm.message.c_str());
  }
}

bool MuteCalls::mutesAll() const {
  return std::any_of(mutes_.list().begin(), mutes_.list().end(),
                     [](const core::Mute& mute) { return mute.mutesAll(); });
}

std::string MuteCalls::ofWhatStands() const {
  return reasonOf(mutes_.active());
}

std::string MuteCalls::ofComponent(const std::string& component) const {
  return reasonOf(mutes_.ofComponent(component));
}

bool MuteCalls::onMute(Call& call) {
  if (calls_.mayServe("mute", call, ros1::steadyNow())) {
    call.getResponse() = serve(call.getRequest(), call.getCallerName());
  }
  return true;
}

bool MuteCalls::onMaintenance(MaintenanceCall& call) {
  if (calls_.mayServe("maintenance", call, ros1::steadyNow())) {
    Mute::Request all;
    all.component = "*";
    all.duration = call.getRequest().duration;
    const Mute::Response said = serve(all, call.getCallerName());
    call.getResponse().success = said.success;
    call.getResponse().message = said.message;
  }
  return true;
}

Mute::Response MuteCalls::serve(const Mute::Request& request, const std::string& caller) {
  Mute::Response response;
  core::Mute mute;
  try {
    mute = muteOf(request);
  } catch (const std::invalid_argument& error) {
    response.message = error.what();
    return response;
  }
  mute.by = ros1::printable(caller, ros1::kLongestName);
  const double duration = request.duration;
  if (duration == 0) {
    const std::optional<core::Mute> ended = mutes_.end(mute);
    response.success = ended.has_value();
    response.message = ended ? "told again: " + what(*ended) + "; " + counts(*ended)
                             : what(mute) + " is not muted";
  } else if (!(duration >= 1 && duration <= kLongest)) {
    response.message = "duration: " + ros1::number(duration) + "; it must be from 1 to " +
                       std::to_string(static_cast<int>(kLongest)) + " s, or 0 to take a mute back";
  } else {
    core::Mute timed = mute;
    timed.until = ros1::steadyNow() + std::llround(duration * 1e9);
    const core::Mute* kept = mutes_.add(timed);
    response.success = kept != nullptr;
    response.message = response.success
                           ? "not told " + until(*kept) + ": " + what(*kept) +
                                 (kept->by == mute.by ? "" : ", as " + kept->by + " wanted")
                           : std::to_string(core::Mutes::kMost) +
                                 " mutes are there, which is the most; take one back, or name "
                                 "several by a *";
  }
  ROS_INFO("%s", response.message.c_str());
  onChange();
  return response;
}

}  // namespace self_awareness
