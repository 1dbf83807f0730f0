#include "verdict_message.h"

#include <cmath>

#include "self_awareness/core/verdict/sentence.h"
#include "self_awareness/ros/ros_time.h"

namespace self_awareness::ros1 {

namespace {

/// The time without an event [s]; NaN: that is not the reason, or not known.
double silenceOf(const core::Reason& reason) {
  using core::Kind;
  if (!std::isnan(reason.silence)) {
    return reason.silence;
  }
  const bool is_silence = reason.unit == core::unit::kSeconds &&
                          (isAbsence(reason.kind) || reason.kind == Kind::kStranger ||
                           (reason.kind == Kind::kLate && reason.after.empty()));
  return is_silence ? reason.value : core::Reason::kNone;
}

}  // namespace

std::vector<self_awareness::Suspect> toMessages(const std::vector<core::Suspect>& suspects,
                                                const core::Vocabulary& vocabulary) {
  std::vector<self_awareness::Suspect> messages;
  for (const core::Suspect& suspect : suspects) {
    const core::EventType& type = vocabulary.at(suspect.id);
    self_awareness::Suspect message;
    message.source = type.source;
    message.scope = type.scope;
    message.type = type.type;
    message.component = core::componentOf(type.source, type.scope);
    const core::Reason& reason = suspect.reason;
    message.reason = reason.words;
    message.kind = core::toString(reason.kind);
    message.after = reason.after;
    message.unit = reason.unit;
    message.value = reason.value;
    message.usual = reason.usual;
    message.abnormal = suspect.abnormal;
    message.onset = toRosTime(suspect.onset);
    message.since = toRosTime(suspect.since);
    message.silence = silenceOf(reason);
    const bool in_seconds = reason.unit == core::unit::kSeconds;
    message.usual_shortest = in_seconds ? reason.usual_shortest : core::Reason::kNone;
    message.usual_longest = in_seconds ? reason.usual_longest : core::Reason::kNone;
    messages.push_back(message);
  }
  return messages;
}

std::string describeOnScope(const self_awareness::Suspect& suspect) {
  const std::size_t field = suspect.type.find('[');
  return suspect.scope + (field == std::string::npos ? "" : " " + suspect.type.substr(field)) +
         ": " + suspect.reason;
}

std::string describe(const self_awareness::Suspect& suspect) {
  return withSource(suspect.source, describeOnScope(suspect));
}

std::string withSource(const std::string& source, const std::string& of_topic) {
  return (source.empty() ? "" : source + " on ") + of_topic;
}

std::string wording(const core::Verdict& verdict, const std::optional<core::Alarm>& standing,
                    const std::string& evidence,
                    const std::vector<self_awareness::Suspect>& new_suspects,
                    const std::string& shared) {
  if (!verdict.threshold) {
    return "not calibrated: find limits with rosrun self_awareness calibrate";
  }
  if (!standing) {
    return verdict.settling ? "settling" : "normal communication";
  }
  std::string message = core::sentence(*standing, shared);
  if (!shared.empty() && !standing->culprit.empty()) {
    message += "; " + shared;
  }
  message += evidence.empty() ? "" : " (" + evidence + ")";
  for (const self_awareness::Suspect& suspect : new_suspects) {
    if (suspect.component != standing->culprit) {
      message += "; now also " + describe(suspect);
    }
  }
  return message;
}

}  // namespace self_awareness::ros1
