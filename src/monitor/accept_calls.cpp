#include "accept_calls.h"

#include <ros/console.h>

#include <algorithm>
#include <exception>
#include <set>
#include <stdexcept>
#include <utility>

#include "ros/now.h"
#include "ros/text.h"
#include "ros/verdict/accepted_file.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/stable_name.h"

namespace self_awareness {
namespace {

constexpr double kPause = 5;  // between two attempts to write the file [s]

std::string inWordsOf(const core::Acceptance& each) {
  std::string words = each.component;
  if (!each.topic.empty() && each.topic != each.component) {
    words += (words.empty() ? "" : " on ") + each.topic;
  }
  return words + (each.kind ? " (" + core::toString(*each.kind) + ")" : "");
}

std::string inWordsOf(const std::vector<core::Acceptance>& all) {
  std::string words;
  for (const core::Acceptance& each : all) {
    words += (words.empty() ? "" : ", ") + inWordsOf(each);
  }
  return words;
}

void checkName(const std::string& name, const char* field) {
  if (name.size() > ros1::kLongestName || !ros1::isPrintable(name)) {
    throw std::invalid_argument(std::string(field) + ": it is no name");
  }
}

std::vector<core::Acceptance> ofNames(const Accept::Request& request) {
  checkName(request.component, "component");
  checkName(request.topic, "topic");
  core::Acceptance acceptance;
  acceptance.component = request.component;
  acceptance.topic = request.topic;
  if (!request.kind.empty()) {
    acceptance.kind = core::kindOf(request.kind);
    if (!acceptance.kind) {
      throw std::invalid_argument("kind: " + ros1::printable(request.kind, ros1::kLongestName) +
                                  " is none; ~alarm tells the kind of what stands");
    }
  }
  if (request.component.empty() && request.topic.empty()) {
    throw std::invalid_argument("name a component or a topic: a kind alone is everybody's");
  }
  // Anonymous nodes have another number with every start.
  if (acceptance.component.find('*') == std::string::npos) {
    acceptance.component = ros1::stableName(acceptance.component);
  }
  return {acceptance};
}

/// What an alarm or a suspicion holds against components: of all that are abnormal by themselves.
std::vector<core::Acceptance> ofAlarm(const core::Alarm& alarm,
                                      const core::Vocabulary& vocabulary) {
  std::vector<core::Acceptance> all;
  for (const std::vector<core::Suspect>& suspects : {alarm.suspects, alarm.later}) {
    for (const core::Suspect& suspect : suspects) {
      if ((suspect.abnormal || suspect.component == alarm.culprit) &&
          suspect.id < vocabulary.size()) {
        core::Acceptance& one = all.emplace_back();
        one.component = suspect.component;
        one.topic = vocabulary.at(suspect.id).scope;
        one.kind = suspect.reason.kind;
      }
    }
  }
  if (all.empty() && !alarm.culprit.empty()) {  // it is of before the start
    core::Acceptance& one = all.emplace_back();
    one.component = alarm.culprit;
    one.kind = alarm.kind;
  }
  return all;
}

std::vector<core::Acceptance> ofIncident(const self_awareness::Incident& incident) {
  std::vector<std::string> names = incident.together;
  names.insert(names.end(), incident.victims.begin(), incident.victims.end());
  if (!incident.component.empty()) {
    names.insert(names.begin(), incident.component);
  }
  std::vector<core::Acceptance> all;
  for (const std::string& name : names) {
    core::Acceptance& one = all.emplace_back();
    one.component = name;
    one.kind = core::kindOf(incident.kind);
  }
  return all;
}

std::vector<core::Acceptance> asked(const Accept::Request& request,
                                    const AcceptCalls::Standing& standing) {
  const bool names = !request.component.empty() || !request.topic.empty() || !request.kind.empty();
  if (names && request.incident != 0) {
    throw std::invalid_argument("incident: name it alone, without component, topic and kind");
  }
  if (names) {
    return ofNames(request);
  }
  std::vector<core::Acceptance> all;
  if (request.incident != 0) {
    const auto& known = standing.incidents.incidents;
    const auto found = std::find_if(known.begin(), known.end(),
                                    [&](const auto& each) { return each.id == request.incident; });
    if (found == known.end()) {
      throw std::invalid_argument("incident: there is none of the id " +
                                  std::to_string(request.incident) + " on ~incidents");
    }
    all = ofIncident(*found);
  } else if (standing.alarm) {
    all = ofAlarm(*standing.alarm, standing.vocabulary);
  } else {
    throw std::invalid_argument(
        "nothing stands; name a component or a topic, or the id of an incident");
  }
  if (all.empty()) {
    throw std::invalid_argument("nobody is to blame for it; name a component or a topic");
  }
  return all;
}

}  // namespace

AcceptCalls::AcceptCalls(OperatorCalls& calls, Handlers handlers)
    : calls_(calls), handlers_(std::move(handlers)), writer_(kPause) {}

ros::ServiceServer AcceptCalls::advertise(ros::NodeHandle& private_node_handle) {
  return private_node_handle.advertiseService("accept", &AcceptCalls::onAccept, this);
}

void AcceptCalls::read(const std::string& model) {
  path_ = ros1::pathOfAccepted(model);
  accepted_ = {};
  try {
    accepted_ = ros1::readAccepted(path_).value_or(core::Acceptances());
  } catch (const std::exception& error) {
    ROS_ERROR("%s; nothing is accepted", error.what());
  }
  if (!accepted_.list().empty()) {
    ROS_INFO("accepted by %s: %s", path_.c_str(), inWordsOf(accepted_.list()).c_str());
  }
}

bool AcceptCalls::covers(const core::Alarm& alarm, const core::Vocabulary& vocabulary) const {
  if (alarm.suspects.empty()) {  // it is of before the start
    return accepted_.covers(alarm.culprit, "", alarm.kind);
  }
  const core::Suspect& first = alarm.suspects.front();
  return first.id < vocabulary.size() &&
         accepted_.covers(first.component, vocabulary.at(first.id).scope, first.reason.kind);
}

void AcceptCalls::tell(const std::vector<core::EventType>& types,
                       ros1::CommunicationState& state) const {
  for (const core::Acceptance& each : accepted_.list()) {
    state.accepted.push_back(inWordsOf(each) + ", by " + each.by);
    std::set<std::string> about;
    for (const core::EventType& type : types) {
      const std::string& component = core::componentOf(type.source, type.scope);
      if (each.extent() != core::Acceptance::Extent::kStranger &&
          each.isAbout(component, type.scope) && about.insert(component).second) {
        std::string& words = state.accepted_of[component];
        words += (words.empty() ? "" : ", ") + inWordsOf(each);
      }
    }
  }
}

bool AcceptCalls::onAccept(Call& call) {
  if (!calls_.mayServe("accept", call, steadyNow())) {
    return true;
  }
  Accept::Response& response = call.getResponse();
  try {
    const std::string caller = ros1::printable(call.getCallerName(), ros1::kLongestName);
    response.message = serve(call.getRequest(), caller);
    response.success = 1U;
    ROS_INFO("%s, by %s", response.message.c_str(), caller.c_str());
    handlers_.on_change(caller);
  } catch (const std::invalid_argument& error) {
    response.success = 0U;
    response.message = error.what();
  }
  return true;
}

std::string AcceptCalls::serve(const Accept::Request& request, const std::string& caller) {
  const std::optional<Standing> standing = handlers_.standing();
  if (!standing) {
    throw std::invalid_argument("there is no model that judges by evidence (~detector)");
  }
  std::vector<core::Acceptance> all = asked(request, *standing);
  core::Acceptances changed = accepted_;
  for (core::Acceptance& each : all) {
    each.at = standing->now;
    each.by = caller;
    if (request.undo != 0U) {
      if (!changed.remove(each)) {
        throw std::invalid_argument(inWordsOf(each) + " is not accepted");
      }
    } else if (!changed.add(each)) {
      throw std::invalid_argument(std::to_string(core::Acceptances::kMost) +
                                  " are accepted, which is the most; take one back, or name "
                                  "several by a *");
    }
  }
  accepted_ = std::move(changed);
  write();
  return (request.undo != 0U ? "judged again: " : "normal from now on: ") + inWordsOf(all) +
         "; kept in " + path_;
}

void AcceptCalls::write() {
  writer_.add({path_, 0, [accepted = accepted_](const std::string& path) {
                 ros1::writeAccepted(accepted, path);
               }});
}

}  // namespace self_awareness
