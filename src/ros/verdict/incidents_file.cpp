#include "incidents_file.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "one_message_file.h"
#include "self_awareness/SelfAwareness.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/ros_time.h"

namespace self_awareness::ros1 {
namespace {

using self_awareness::SelfAwareness;

// Names have 1000 bytes at most (kLongestName), and hardly any has more than a tenth of that.
constexpr OneMessageFile kFileOfIncidents{kIncidentsFile, "/incidents",
                                          "the incidents in it are damaged", 16 << 20};

bool isId(std::uint64_t id) {
  return id > 0 && id < std::numeric_limits<std::int64_t>::max();
}

void checkNames(const std::vector<std::string>& names) {
  check(names.size() <= core::Incident::kMostNamed, "it has too many components");
  check(std::all_of(names.begin(), names.end(),
                    [](const std::string& name) { return name.size() <= kLongestName; }),
        "the name of a component is too long");
}

void checkIncidents(const self_awareness::Incidents& incidents) {
  check(incidents.incidents.size() <= kMostIncidents, "there are too many");
  for (const self_awareness::Incident& each : incidents.incidents) {
    check(each.level == SelfAwareness::WARN || each.level == SelfAwareness::ERROR,
          "the level of one is none");
    check(isId(each.id) && isId(each.last), "the id of one is none");
    check(core::kindOf(each.kind).has_value(), "the kind of one is none");
    checkNames({each.component});
    checkNames(each.together);
    checkNames(each.victims);
    checkNames(each.others);
    checkNames(each.hosts);
  }
}

}  // namespace

self_awareness::Incident toMessage(const core::Incident& incident) {
  self_awareness::Incident message;
  message.id = incident.id;
  message.last = incident.last;
  message.level =
      incident.level == core::Alarm::Level::kAlarm ? SelfAwareness::ERROR : SelfAwareness::WARN;
  message.kind = core::toString(incident.kind);
  message.component = incident.cause;
  message.reason = incident.reason;
  message.together = incident.together;
  message.victims = incident.victims;
  message.others = incident.others;
  message.hosts = incident.hosts;
  message.opened = toRosTime(incident.opened);
  message.grown = toRosTime(incident.grown);
  message.ended = toRosTime(incident.end);
  message.over = incident.over;
  message.unknown = incident.unknown;
  message.alarms = incident.alarms;
  message.near_misses = incident.near_misses;
  return message;
}

core::Incident fromMessage(const self_awareness::Incident& message) {
  core::Incident incident;
  incident.id = incident.main = message.id;
  incident.last = message.last;
  incident.level = message.level == SelfAwareness::ERROR ? core::Alarm::Level::kAlarm
                                                         : core::Alarm::Level::kSuspicion;
  incident.kind = core::kindOf(message.kind).value();
  incident.cause = message.component;
  incident.reason = message.reason;
  incident.together = message.together;
  incident.victims = message.victims;
  incident.others = message.others;
  incident.hosts = message.hosts;
  incident.opened = fromRosTime(message.opened);
  incident.grown = fromRosTime(message.grown);
  incident.end = fromRosTime(message.ended);
  incident.over = message.over != 0U;
  incident.unknown = message.unknown != 0U;
  incident.alarms = message.alarms;
  incident.near_misses = message.near_misses;
  incident.main_duration = incident.end - incident.opened;
  return incident;
}

void writeIncidents(const self_awareness::Incidents& incidents, const std::string& path) {
  writeOneMessage(kFileOfIncidents, incidents, incidents.header.stamp, path);
}

std::optional<self_awareness::Incidents> readIncidents(const std::string& path) {
  return readOneMessage<self_awareness::Incidents>(kFileOfIncidents, path, checkIncidents);
}

}  // namespace self_awareness::ros1
