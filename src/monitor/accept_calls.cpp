#include "accept_calls.h"

#include <ros/console.h>

#include <algorithm>
#include <exception>
#include <iterator>
#include <set>
#include <stdexcept>
#include <utility>

#include "core/verdict/name_list.h"
#include "diagnostics.h"
#include "ros/text.h"
#include "ros/verdict/kept_files.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/ros_time.h"
#include "session.h"

namespace self_awareness {
AcceptCalls::AcceptCalls(OperatorCalls& calls, Handlers handlers)
    : calls_(calls), handlers_(std::move(handlers)) {}

std::vector<ros::ServiceServer> AcceptCalls::advertise(ros::NodeHandle& private_node_handle) {
  return {private_node_handle.advertiseService("accept", &AcceptCalls::onAccept, this)};
}

void AcceptCalls::onStart(const Session& session, const std::string& path) {
  session_ = &session;
  read(path);
}

void AcceptCalls::read(const std::string& model) {
  path_ = ros1::pathOfAccepted(model);
  if (written_.done && !*written_.done && written_.path == path_) {
    accepted_ = written_.accepted;
  } else {
    accepted_ = {};
    try {
      accepted_ = ros1::readAccepted(path_).value_or(core::Acceptances());
    } catch (const std::exception& error) {
      ROS_ERROR("%s; nothing is accepted", error.what());
    }
  }
  if (!accepted_.list().empty()) {
    ROS_INFO("accepted by %s: %s", path_.c_str(), inWordsOf(accepted_.list()).c_str());
  }
}

bool AcceptCalls::covers(const core::Alarm& alarm, const core::Vocabulary& vocabulary) const {
  if (alarm.kind == core::Kind::kNewMode) {
    return alarm.silent && accepted_.coversMode(alarm.silent->components);
  }
  if (alarm.suspects.empty()) {  // it is of before the start
    return accepted_.covers(alarm.culprit, "", alarm.kind);
  }
  const core::Suspect& first = alarm.suspects.front();
  const core::Kind kind = first.reason.kind;
  const auto covers = [&](const std::string& topic) {
    return accepted_.covers(first.component, topic, kind) ||
           (core::isAbsence(kind) && accepted_.mayBeAbsent(first.component, topic));
  };
  const std::vector<std::string>& topics = first.reason.topics;
  if (!topics.empty()) {
    return std::all_of(topics.begin(), topics.end(), covers);
  }
  return first.id < vocabulary.size() && covers(vocabulary.at(first.id).scope);
}

void AcceptCalls::onReport(MonitorState& state) {
  state.accept_error = error();
  if (session_ != nullptr) {
    tell(session_->types(), state.communication);
  }
}

void AcceptCalls::tell(const std::vector<core::EventType>& types,
                       ros1::CommunicationState& state) const {
  for (const core::Acceptance& each : accepted_.list()) {
    state.accepted.push_back(inWordsOf(each) + ", by " + each.by);
    std::set<std::string> about;
    for (const core::EventType& type : types) {
      const std::string& component = core::componentOf(type.source, type.scope);
      if (each.extent() != core::Acceptance::Extent::kStranger && concerns(each, type) &&
          about.insert(component).second) {
        std::string& words = state.accepted_of[component];
        words += (words.empty() ? "" : ", ") + inWordsOf(each);
      }
    }
  }
}

bool AcceptCalls::onAccept(Call& call) {
  if (!asksWhat(call.getRequest()) && !calls_.mayServe("accept", call, ros1::steadyNow())) {
    return true;
  }
  // What does not belong in a text takes three bytes, and a longer name could not be read again.
  const std::string caller = ros1::printable(call.getCallerName(), ros1::kLongestName / 3);
  call.getResponse() = serve(call.getRequest(), caller);
  return true;
}

Accept::Response AcceptCalls::serve(const Accept::Request& request, const std::string& caller) {
  Accept::Response response;
  const std::optional<Acceptable> acceptable = handlers_.acceptable();
  if (!acceptable) {
    response.message = "there is no model that judges by evidence (~detector)";
    return response;
  }
  if (asksWhat(request)) {
    response.message = offerOf(request, *acceptable, accepted_);
    return response;
  }
  WantedAcceptances wanted;
  try {
    wanted = requestOf(request, *acceptable, accepted_);
  } catch (const std::invalid_argument& error) {
    response.message = error.what();
    return response;
  }
  const std::size_t named = wanted.asked.size() + wanted.refused.size();
  const bool undo = request.undo != 0U;
  const std::vector<core::Acceptance> done =
      undo ? takeBack(wanted) : accept(*acceptable, caller, wanted);
  const std::size_t refused = wanted.refused.size();
  response.success = refused == 0 ? 1U : 0U;
  if (named - refused == 0) {
    response.message = core::listed(wanted.refused, kMostNamed);
    return response;
  }
  write();
  if (named > 1) {
    response.message = std::to_string(named - refused) + " of " + std::to_string(named) + ": ";
  }
  response.message +=
      (undo ? "judged again: " : "normal from now on: ") + inWordsOf(done) +
      (refused == 0 ? "" : "; refused: " + core::listed(wanted.refused, kMostNamed)) +
      "; kept in " + path_ + (undo ? "" : unknownOf(done, acceptable->vocabulary));
  ROS_INFO("%s, by %s", response.message.c_str(), caller.c_str());
  handlers_.on_change(caller);
  return response;
}

std::vector<core::Acceptance> AcceptCalls::accept(const Acceptable& acceptable,
                                                  const std::string& caller,
                                                  WantedAcceptances& request) {
  std::vector<core::Acceptance> done;
  for (core::Acceptance each : request.asked) {
    each.at = acceptable.now;
    each.by = caller;
    if (accepted_.add(each)) {
      done.push_back(std::move(each));
    } else {
      request.refused.push_back(inWordsOf(each) + ": " + std::to_string(core::Acceptances::kMost) +
                                " are accepted, which is the most; take one back, or name "
                                "several by a *");
    }
  }
  return done;
}

std::vector<core::Acceptance> AcceptCalls::takeBack(WantedAcceptances& request) {
  std::vector<core::Acceptance> done;
  for (const core::Acceptance& each : request.asked) {
    std::vector<core::Acceptance> removed = accepted_.remove(each);
    if (removed.empty()) {
      request.refused.push_back(
          inWordsOf(each) + " is not accepted; " +
          (accepted_.list().empty() ? "nothing is" : "these are: " + inWordsOf(accepted_.list())));
    }
    std::move(removed.begin(), removed.end(), std::back_inserter(done));
  }
  return done;
}

std::string AcceptCalls::unknownOf(const std::vector<core::Acceptance>& all,
                                   const core::Vocabulary& vocabulary) {
  std::vector<core::Acceptance> unknown;
  std::copy_if(all.begin(), all.end(), std::back_inserter(unknown),
               [&](const core::Acceptance& each) { return !isKnown(each, vocabulary); });
  return unknown.empty() ? "" : "; nobody of that name is known yet: " + inWordsOf(unknown);
}

void AcceptCalls::write() {
  written_ = {path_, accepted_, std::make_shared<std::atomic<bool>>(false)};
  writer_.add({path_, 0, [accepted = accepted_, done = written_.done](const std::string& path) {
                 ros1::writeAccepted(accepted, path);
                 *done = true;
               }});
}

}  // namespace self_awareness
