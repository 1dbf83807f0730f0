#include "standing_alarm.h"

#include <limits>

#include "one_message_file.h"
#include "self_awareness/ros/ros_time.h"

namespace self_awareness::ros1 {
namespace {

// Of many times the bytes that an alarm needs.
constexpr OneMessageFile kFileOfAlarm{kStandingAlarmFile, "/standing_alarm",
                                      "the alarm in it is damaged", 1 << 20};

void checkAlarm(const self_awareness::StandingAlarm& standing) {
  using self_awareness::SelfAwareness;
  const SelfAwareness& alarm = standing.alarm;
  check(alarm.level <= SelfAwareness::ERROR, "its level is none");
  check(alarm.suspects.size() <= core::kMostSuspects, "it has too many suspects");
  for (const self_awareness::Suspect& suspect : alarm.suspects) {
    check(core::kindOf(suspect.kind).has_value(), "the kind of a suspect is none");
  }
  if (alarm.level == SelfAwareness::ERROR) {
    check(alarm.alarm > 0 && alarm.alarm < std::numeric_limits<std::int64_t>::max(),
          "its id is none");
    check(core::kindOf(alarm.kind).has_value(), "its kind is none");
  }
}

}  // namespace

void writeStandingAlarm(const self_awareness::StandingAlarm& standing, const std::string& path) {
  writeOneMessage(kFileOfAlarm, standing, standing.alarm.header.stamp, path);
}

std::optional<self_awareness::StandingAlarm> readStandingAlarm(const std::string& path) {
  std::optional<self_awareness::StandingAlarm> standing =
      readOneMessage<self_awareness::StandingAlarm>(kFileOfAlarm, path, checkAlarm);
  return standing && standing->alarm.level == self_awareness::SelfAwareness::ERROR ? standing
                                                                                   : std::nullopt;
}

std::vector<core::Suspect> fromMessages(const std::vector<self_awareness::Suspect>& messages,
                                        const core::Vocabulary& vocabulary) {
  std::vector<core::Suspect> suspects;
  for (const self_awareness::Suspect& message : messages) {
    const std::optional<core::EventId> id =
        vocabulary.find({message.source, message.scope, message.type});
    const std::optional<core::Kind> kind = core::kindOf(message.kind);
    if (id && kind) {
      core::Suspect suspect;
      suspect.id = *id;
      suspect.component = message.component;
      suspect.topic = message.scope;
      suspect.value = core::valueOf(vocabulary.at(*id));
      suspect.abnormal = message.abnormal;
      suspect.onset = fromRosTime(message.onset);
      suspect.since = fromRosTime(message.since);
      suspect.reason.kind = *kind;
      suspect.reason.after = message.after;
      suspect.reason.unit = message.unit;
      suspect.reason.value = message.value;
      suspect.reason.usual = message.usual;
      suspect.reason.words = message.reason;
      suspects.push_back(suspect);
    }
  }
  return suspects;
}

}  // namespace self_awareness::ros1
