#include "alarm_state.h"

#include <algorithm>
#include <limits>

#include "self_awareness/core/stream/event.h"
#include "self_awareness/ros/ros_time.h"
#include "verdict_message.h"

namespace self_awareness::ros1 {
namespace {

std::uint8_t levelOf(const std::optional<core::Alarm>& standing) {
  using self_awareness::SelfAwareness;
  if (!standing) {
    return SelfAwareness::OK;
  }
  return standing->level == core::Alarm::Level::kAlarm ? SelfAwareness::ERROR
                                                       : SelfAwareness::WARN;
}

std::string inWords(const core::Verdict& verdict, const std::string& load) {
  std::string words = verdict.busy ? core::describe(*verdict.busy, load) : "";
  if (verdict.silent) {
    words += (words.empty() ? "" : ", ") + core::describe(*verdict.silent);
  }
  return words;
}

}  // namespace

void AlarmState::add(const core::Verdict& verdict, const core::Vocabulary& vocabulary,
                     std::int64_t window, const Circumstances& circumstances) {
  const auto before = std::pair(message_.kind, message_.component);
  take(verdict, vocabulary, window, circumstances);
  handlers_.on_status(message_);
  if (verdict.changed || (stands() && std::pair(message_.kind, message_.component) != before)) {
    handlers_.on_alarm(message_);
    handlers_.on_diagnostics();
  }
}

void AlarmState::take(const core::Verdict& verdict, const core::Vocabulary& vocabulary,
                      std::int64_t window, const Circumstances& circumstances) {
  const std::int64_t end = verdict.window->start + window;
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  ended_ = alarms_.add(verdict, window, vocabulary);
  tell(alarms_.standing() ? alarms_.standing() : ended_);
  const std::uint8_t level = levelOf(alarms_.standing());
  if (level != message_.level) {
    level_since_ = end;
  }
  message_.level = level;
  if (!verdict.suspects.empty() || !stands()) {
    message_.suspects = toMessages(verdict.suspects, vocabulary);
  }
  if (!verdict.evidence.empty() || !stands()) {
    message_.evidence = verdict.evidence;
    shared_ = inWords(verdict, circumstances.load);
  }
  message_.message = wording(verdict, alarms_.standing(), message_.evidence,
                             toMessages(verdict.new_suspects, vocabulary), shared_);
  if (verdict.alarm) {
    recording_ = circumstances.recording;
    message_.message += recording_.empty() ? "" : "; events in " + recording_;
  }
  message_.header.stamp = toRosTime(end);
  message_.window_start = toRosTime(verdict.window->start);
  message_.window.fromNSec(window);
  message_.score = verdict.score.value_or(kNone);
  message_.threshold = verdict.threshold.value_or(kNone);
  message_.abnormal = verdict.abnormal && !verdict.settling;
  message_.settling = verdict.settling;
  message_.events = static_cast<std::uint32_t>(verdict.window->events.size());
  message_.unknown_events = static_cast<std::uint32_t>(verdict.window->unknown());
}

void AlarmState::resume(const self_awareness::StandingAlarm& before,
                        std::vector<core::Suspect> suspects) {
  const self_awareness::SelfAwareness& alarm = before.alarm;
  level_since_ = fromRosTime(before.since);
  core::Alarm standing;
  standing.id = alarm.alarm;
  standing.level = core::Alarm::Level::kAlarm;
  standing.begin = standing.end = level_since_;
  standing.kind = core::kindOf(alarm.kind).value();
  standing.culprit = alarm.component;
  standing.reason = alarm.reason;
  standing.evidence = alarm.evidence;
  // A message does not say on how many topics somebody is who should not be there.
  suspects.erase(std::remove_if(suspects.begin(), suspects.end(),
                                [](const core::Suspect& suspect) {
                                  const core::Kind kind = suspect.reason.kind;
                                  return kind == core::Kind::kStranger ||
                                         kind == core::Kind::kUnsubscribed ||
                                         kind == core::Kind::kTwoSenders;
                                }),
                 suspects.end());
  standing.suspects = std::move(suspects);
  alarms_.resume(std::move(standing));
  message_ = alarm;
  recording_ = before.recording;
  handlers_.on_alarm(message_);
}

void AlarmState::standDown(const std::string& message, std::int64_t now) {
  const bool stood = stands();
  ended_ = alarms_.end(now);
  tell(ended_);
  message_.level = self_awareness::SelfAwareness::OK;
  message_.message = message;
  message_.abnormal = false;
  message_.suspects.clear();
  message_.evidence.clear();
  shared_.clear();
  message_.header.stamp = toRosTime(now);
  if (stood) {
    handlers_.on_alarm(message_);
  }
  handlers_.on_diagnostics();
}

void AlarmState::tell(const std::optional<core::Alarm>& alarm) {
  message_.alarm = alarm ? alarm->id : 0;
  message_.kind = alarm ? core::toString(alarm->kind) : "";
  message_.component = alarm ? alarm->culprit : "";
  message_.reason = alarm ? alarm->reason : "";
}

void AlarmState::forgetWindow() {
  const auto level = message_.level;
  message_ = {};
  message_.level = level;
  tell(alarms_.standing());
}

double AlarmState::standsFor(std::int64_t now) const {
  return core::toSeconds(now - level_since_);
}

}  // namespace self_awareness::ros1
