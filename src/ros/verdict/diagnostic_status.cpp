#include "diagnostic_status.h"

#include <ros/serialization.h>

#include <cmath>
#include <cstddef>
#include <cstdio>

#include "alarm_state.h"
#include "self_awareness/core/evidence/tuning.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/ros/ros_time.h"
#include "verdict_message.h"

namespace self_awareness::ros1 {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;

void CommunicationState::take(const AlarmState& alarm, const HeardReport& report,
                              std::int64_t now) {
  started = alarm.spoken();
  last = alarm.message();
  level_for = alarm.standsFor(now);
  heard = report;
}

DiagnosticStatuses::DiagnosticStatuses(const std::string& node, const std::string& hardware_id,
                                       std::int64_t now)
    : prefix_(node.substr(node.rfind('/') + 1) + ": "), hardware_id_(hardware_id) {
  const std::string full = node.substr(node.find_first_not_of('/'));
  const std::size_t end = full.rfind('/');
  if (end != std::string::npos) {
    suffix_ = " (" + full.substr(0, end) + ")";
  }
  message_.header.stamp = toRosTime(now);
}

void DiagnosticStatuses::add(const std::string& name, const DiagnosticStatusWrapper& status) {
  DiagnosticStatus& added = message_.status.emplace_back(status);
  added.name = prefix_ + name + suffix_;
  added.hardware_id = hardware_id_;
}

std::string number(double value) {
  if (std::isnan(value)) {
    return "none";
  }
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

namespace {

constexpr char kNotWatchedAccepted[] = "not watched: accepted";
constexpr std::size_t kMostTopics = 20;

/// A share as people read it: "110 %".
std::string percent(double share) {
  if (std::isnan(share)) {
    return number(share);
  }
  char text[320];
  std::snprintf(text, sizeof text, "%.0f %%", 100 * share + 0.0);  // never -0
  return text;
}

std::vector<std::string> notWatched(const CommunicationState& state) {
  std::vector<std::string> names;
  for (const core::evidence::Coverage& each : state.coverage) {
    if (!each.isWatched()) {
      names.push_back(each.component + (each.accepted ? " (accepted)" : ""));
    }
  }
  return names;
}

std::vector<std::string> unheard(const CommunicationState& state) {
  std::vector<std::string> names;
  for (const auto& [source, topic] : state.unheard) {
    names.push_back(withSource(source, topic));
  }
  return names;
}

std::vector<std::string> strangers(const CommunicationState& state) {
  std::vector<std::string> words;
  for (const CommunicationState::Stranger& each : state.strangers) {
    words.push_back(withSource(each.source, each.topic) + ": " + std::to_string(each.events));
  }
  return words;
}

// Where nobody looks, it is not quiet.
void tellNotWatched(const CommunicationState& state, DiagnosticStatusWrapper& status) {
  const std::vector<std::string> names = notWatched(state);
  if (!names.empty() && status.level == DiagnosticStatus::OK) {
    status.summary(DiagnosticStatus::OK, status.message + "; " + std::to_string(names.size()) +
                                             " of " + std::to_string(state.coverage.size()) +
                                             " components are not watched");
  }
}

// Whether one that may be absent is: its death would have been found.
bool isAbsent(const HeardReport::Component& component, const core::evidence::Coverage* coverage) {
  return !component.last_heard || (coverage != nullptr && coverage->death_found_after &&
                                   *component.last_heard > *coverage->death_found_after);
}

// As users of hz_monitor are used to: how often messages come, and should.
void tellRates(const CommunicationState& state, const std::string& name,
               const HeardReport::Component& component, DiagnosticStatusWrapper& status) {
  const auto expected = state.expected.find(name);
  if (expected == state.expected.end()) {
    return;
  }
  std::size_t told = 0;
  for (const auto& [topic, rate] : expected->second) {
    if (told++ < kMostTopics) {
      const auto actual = component.rates.find(topic);
      char text[48];
      std::snprintf(text, sizeof text, "%.3g of %.3g Hz",
                    actual == component.rates.end() ? 0.0 : actual->second, rate);
      status.add(topic, text);
    }
  }
  if (told > kMostTopics) {
    status.add("further topics", told - kMostTopics);
  }
}

bool isMuted(const CommunicationState& state) {
  return !state.muted.empty() && state.last.level != DiagnosticStatus::OK;
}

// How soon its death is found.
std::string deathFoundAfter(const core::evidence::Coverage& component) {
  if (component.isWatched()) {
    return core::evidence::foundAfter(component, "");
  }
  return component.accepted ? kNotWatchedAccepted : "not watched";
}

}  // namespace

std::string whyNotWatched(const core::evidence::Coverage& component) {
  if (component.isWatched()) {
    return "";
  }
  if (component.accepted) {
    return "accepted";
  }
  return static_cast<double>(component.gaps) < core::evidence::Tuning().fewest_gaps
             ? "too few messages in training: " + std::to_string(component.gaps) + " gaps"
             : "all of it came at one moment in training";
}

std::vector<std::pair<std::string, std::vector<std::string>>> listsOf(
    const CommunicationState& state) {
  return {{"not watched", notWatched(state)},
          {"watched less now", state.watched_less},
          {"nobody subscribed in training", unheard(state)},
          {"not accepted, events so far", strangers(state)},
          {"accepted", state.accepted},
          {"off together, as is accepted", state.mode}};
}

void tellCommunication(const CommunicationState& state, DiagnosticStatusWrapper& status) {
  const self_awareness::SelfAwareness& last = state.last;
  if (!state.model_error.empty()) {
    status.summary(DiagnosticStatus::ERROR, "no model: " + state.model_error);
  } else if (!state.nothing_heard.empty()) {
    status.summary(DiagnosticStatus::WARN, state.nothing_heard);
  } else if (!state.started) {
    status.summary(DiagnosticStatus::OK, "waiting for the first message");
  } else {
    // Not an alarm, but an operator who relies on one must know that none can come.
    const std::uint8_t uncalibrated = DiagnosticStatus::WARN;
    status.summary(state.calibrated ? last.level : uncalibrated, last.message);
    if (isMuted(state) && state.calibrated) {
      status.summary(DiagnosticStatus::OK, "muted (" + state.muted + "): " + last.message);
    }
    const std::size_t heard = state.heard.known_types + state.heard.unknown_types;
    if (!last.settling && static_cast<double>(state.heard.known_types) <
                              core::kLeastKnown * static_cast<double>(heard)) {
      status.mergeSummary(DiagnosticStatus::WARN,
                          "the model knows " + std::to_string(state.heard.known_types) +
                              " of the " + std::to_string(heard) +
                              " event types that were heard: is it of this robot?");
    }
    tellNotWatched(state, status);
    for (const auto& [key, list] : listsOf(state)) {
      tellList(key, list, state.lists, status);
    }
    if (last.threshold < 0) {  // of the evidence detector
      status.add("share of limit", percent(last.score / last.threshold));
    } else {
      status.add("score", number(last.score));
      status.add("threshold", number(last.threshold));
    }
    status.add("events in the window", last.events);
    status.add("unknown events in the window", last.unknown_events);
    if (last.level != DiagnosticStatus::OK) {
      status.add("alarm", last.alarm);
      status.add("kind", last.kind);
      status.add("component", last.component);
      status.add("evidence", last.evidence);
      status.add("for [s]", number(state.level_for));
    }
    for (std::size_t i = 0; i < last.suspects.size(); ++i) {
      status.add("suspect " + std::to_string(i + 1), describe(last.suspects[i]));
    }
  }
  status.add("model", state.model);
}

void tellComponent(const CommunicationState& state, const std::string& name,
                   const core::evidence::Coverage* coverage, DiagnosticStatusWrapper& status) {
  const HeardReport::Component& component = state.heard.components.at(name);
  status.summary(DiagnosticStatus::OK, component.last_heard ? "heard" : "not heard yet");
  const std::vector<self_awareness::Suspect>& suspects = state.last.suspects;
  const auto suspect = std::find_if(suspects.begin(), suspects.end(), [&](const auto& each) {
    return core::componentOf(each.source, each.scope) == name;
  });
  // One is to blame; others may well be its victims, and who is within its limits is well.
  const bool is_named = suspect != suspects.end();
  const bool is_to_blame = name == state.last.component;
  const bool is_left = is_to_blame && suspects.empty();
  if (state.last.level != DiagnosticStatus::OK &&
      (is_left || (is_named && (is_to_blame || suspect->abnormal)))) {
    const std::string words = is_named ? describeOnScope(*suspect) : state.last.reason;
    if (isMuted(state)) {
      status.summary(DiagnosticStatus::OK, "muted: " + words);
    } else {
      status.summary(
          is_to_blame ? state.last.level : static_cast<std::uint8_t>(DiagnosticStatus::WARN),
          words);
    }
  }
  const auto restarts = state.restarts.find(name);
  if (restarts != state.restarts.end()) {
    const auto& [words, too_often] = restarts->second;
    status.add("restarts", words);
    if (too_often && status.level == DiagnosticStatus::OK) {
      status.summary(DiagnosticStatus::WARN, words);
    }
  }
  const bool absent = state.optional.count(name) > 0 && isAbsent(component, coverage);
  if (absent && status.level == DiagnosticStatus::OK) {
    status.summary(DiagnosticStatus::OK, "optional (absent)");
  }
  const auto not_heard = state.not_heard.find(name);
  if (!absent && status.level == DiagnosticStatus::OK && not_heard != state.not_heard.end()) {
    status.summary(DiagnosticStatus::WARN, not_heard->second);
  }
  if (coverage != nullptr && coverage->accepted && status.level == DiagnosticStatus::OK) {
    status.summary(DiagnosticStatus::OK, status.message + "; " + kNotWatchedAccepted);
  }
  if (component.last_heard) {
    status.add("last heard [s ago]", number(*component.last_heard));
  }
  status.add("events a second", number(component.rate));
  tellRates(state, name, component, status);
  const auto share = state.shares.find(name);
  if (share != state.shares.end()) {
    status.add("share of limit", percent(share->second));
  }
  const auto accepted = state.accepted_of.find(name);
  if (accepted != state.accepted_of.end()) {
    status.add("accepted", accepted->second);
  }
  if (coverage != nullptr) {
    status.add("death found after [s]", deathFoundAfter(*coverage));
    if (!coverage->isWatched()) {
      status.add("why not watched", whyNotWatched(*coverage));
    }
    const std::string late = core::evidence::lateAnswers(*coverage);
    if (!late.empty()) {
      status.add("late answers", late);
    }
  }
}

void addComponents(const CommunicationState& state, DiagnosticStatuses& statuses) {
  std::map<std::string, const core::evidence::Coverage*> coverage;
  for (const core::evidence::Coverage& each : state.coverage) {
    coverage[each.component] = &each;
  }
  for (const auto& [name, component] : state.heard.components) {
    const auto known = coverage.find(name);
    DiagnosticStatusWrapper status;
    tellComponent(state, name, known == coverage.end() ? nullptr : known->second, status);
    statuses.add(name, status);
  }
}

void addChosen(const DiagnosticStatuses& of_components, StatusRound& round, double elapsed,
               DiagnosticStatuses& statuses) {
  const std::size_t others = ros::serialization::serializationLength(statuses.message());
  for (const DiagnosticStatus& status :
       round.next(of_components.message().status, others, elapsed)) {
    statuses.add(status);
  }
}

diagnostic_msgs::DiagnosticArray toDiagnostics(const CommunicationState& state,
                                               const std::string& node, std::int64_t now) {
  DiagnosticStatuses statuses(node, kNoHardware, now);
  DiagnosticStatusWrapper whole;
  tellCommunication(state, whole);
  statuses.add("communication", whole);
  addComponents(state, statuses);
  return statuses.message();
}

}  // namespace self_awareness::ros1
