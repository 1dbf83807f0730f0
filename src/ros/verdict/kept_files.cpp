#include "kept_files.h"

#include <ros/time.h>
#include <rosbag/exceptions.h>

#include <algorithm>
#include <boost/filesystem/operations.hpp>
#include <cstdint>
#include <limits>
#include <new>
#include <stdexcept>

#include "../bag/bag_index.h"
#include "../bag/stored_messages.h"
#include "../bag/version_of_bag.h"
#include "../check.h"
#include "self_awareness/Acceptances.h"
#include "self_awareness/SelfAwareness.h"
#include "self_awareness/ros/bag/bag_reader.h"
#include "self_awareness/ros/bag/bag_writer.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/file_version.h"
#include "self_awareness/ros/output_file.h"
#include "self_awareness/ros/ros_time.h"

namespace self_awareness::ros1 {
namespace {

using self_awareness::SelfAwareness;

/// A file that holds one message, for another start of the monitor.
struct OneMessageFile {
  FileKind kind;
  const char* topic;
  const char* damaged;       ///< what is said of a file that cannot be read
  std::uint64_t most_bytes;  ///< a larger one is not read
};

/// Writes the whole file or nothing (see OutputFile).
/// @throw FileError or BagError if it cannot be written
template <typename Message>
void writeOneMessage(const OneMessageFile& of, const Message& message, const ros::Time& stamp,
                     const std::string& path) {
  OutputFile file(path);
  BagWriter bag(file.temporary(), BagWriter::Chunks::kOfOneMessage, path);
  const ros::Time at = std::max(stamp, ros::TIME_MIN);
  bag.write({kVersionTopic}, at, versionOf(of.kind));
  bag.write({of.topic}, at, message);
  bag.close();
  file.complete();
}

/// @param checkContent throws std::invalid_argument if the content cannot be
/// @return none: there is no file
/// @throw BagError if it is damaged, or no such file; names it
template <typename Message, typename Check>
std::optional<Message> readOneMessage(const OneMessageFile& of, const std::string& path,
                                      const Check& checkContent) {
  const auto damaged = [&](const std::string& why) {
    return BagError(path + ": " + of.damaged + why);
  };
  boost::system::error_code error;
  if (!boost::filesystem::exists(path, error)) {
    return std::nullopt;
  }
  try {
    // To open a pipe would wait for its writer.
    check(boost::filesystem::is_regular_file(path, error) &&
              boost::filesystem::file_size(path, error) <= of.most_bytes,
          "it is no such file");
    const BagIndex index = readBagIndex(path);
    checkedVersion(path, index, of.kind);
    StoredMessages messages(path, index, of.most_bytes);
    std::optional<Message> found;
    for (const BagIndexEntry& entry : index.entries) {
      if (holds<Message>(index.connections[entry.connection])) {
        check(!found, "it holds several of them");
        found = messages.read<Message>(entry);
      }
    }
    check(found.has_value(), "it holds none");
    checkContent(*found);
    return found;
  } catch (const rosbag::BagException& problem) {
    throw damaged(std::string(" (") + problem.what() + ")");
  } catch (const std::invalid_argument& problem) {
    throw damaged(std::string(" (") + problem.what() + ")");
  } catch (const std::bad_alloc&) {
    throw damaged("");
  }
}

// Of many times the bytes that an alarm needs.
constexpr OneMessageFile kFileOfAlarm{kStandingAlarmFile, "/standing_alarm",
                                      "the alarm in it is damaged", 1 << 20};

bool isId(std::uint64_t id) {
  return id > 0 && id < std::numeric_limits<std::int64_t>::max();
}

void checkAlarm(const self_awareness::StandingAlarm& standing) {
  const SelfAwareness& alarm = standing.alarm;
  check(alarm.level <= SelfAwareness::ERROR, "its level is none");
  check(alarm.suspects.size() <= core::kMostSuspects, "it has too many suspects");
  for (const self_awareness::Suspect& suspect : alarm.suspects) {
    check(core::kindOf(suspect.kind).has_value(), "the kind of a suspect is none");
  }
  if (alarm.level == SelfAwareness::ERROR) {
    check(isId(alarm.alarm), "its id is none");
    check(core::kindOf(alarm.kind).has_value(), "its kind is none");
  }
}

// Names have 1000 bytes at most (kLongestName), and hardly any has more than a tenth of that.
constexpr OneMessageFile kFileOfIncidents{kIncidentsFile, "/incidents",
                                          "the incidents in it are damaged", 16 << 20};

bool areNames(const std::vector<std::string>& names) {
  return std::all_of(names.begin(), names.end(),
                     [](const std::string& name) { return name.size() <= kLongestName; });
}

void checkNames(const std::vector<std::string>& names) {
  check(names.size() <= core::Incident::kMostNamed, "it has too many components");
  check(areNames(names), "the name of a component is too long");
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

constexpr OneMessageFile kFileOfAccepted{kAcceptedFile, "/accepted",
                                         "what is accepted in it is damaged", 4 << 20};

void checkContent(const self_awareness::Acceptances& accepted) {
  check(accepted.accepted.size() <= core::Acceptances::kMost, "there are too many");
  for (const self_awareness::Acceptance& each : accepted.accepted) {
    const bool is_mode = core::kindOf(each.kind) == core::Kind::kNewMode;
    check(is_mode ? !each.together.empty() : !each.component.empty() || !each.topic.empty(),
          "one names nobody");
    check(is_mode ? each.component.empty() && each.topic.empty() : each.together.empty(),
          "one is of a component and of a mode");
    check(areNames({each.component, each.topic, each.by}) && areNames(each.together),
          "a name is too long");
    check(std::is_sorted(each.together.begin(), each.together.end()),
          "the components of a mode are in no order");
    check(each.kind.empty() || core::kindOf(each.kind).has_value(), "the kind of one is none");
  }
}

}  // namespace

void writeStandingAlarm(const self_awareness::StandingAlarm& standing, const std::string& path) {
  writeOneMessage(kFileOfAlarm, standing, standing.alarm.header.stamp, path);
}

std::optional<self_awareness::StandingAlarm> readStandingAlarm(const std::string& path) {
  std::optional<self_awareness::StandingAlarm> standing =
      readOneMessage<self_awareness::StandingAlarm>(kFileOfAlarm, path, checkAlarm);
  return standing && standing->alarm.level == SelfAwareness::ERROR ? standing : std::nullopt;
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

std::string pathOfAccepted(const std::string& model) {
  return model + ".accepted";
}

void writeAccepted(const core::Acceptances& accepted, const std::string& path) {
  self_awareness::Acceptances message;
  std::int64_t latest = 0;
  for (const core::Acceptance& each : accepted.list()) {
    self_awareness::Acceptance& one = message.accepted.emplace_back();
    one.component = each.component;
    one.topic = each.topic;
    one.kind = each.kind ? core::toString(*each.kind) : "";
    one.together = each.together;
    one.at = toRosTime(each.at);
    one.by = each.by;
    latest = std::max(latest, each.at);
  }
  writeOneMessage(kFileOfAccepted, message, toRosTime(latest), path);
}

std::optional<core::Acceptances> readAccepted(const std::string& path) {
  const auto message =
      readOneMessage<self_awareness::Acceptances>(kFileOfAccepted, path, checkContent);
  if (!message) {
    return std::nullopt;
  }
  core::Acceptances accepted;
  for (const self_awareness::Acceptance& one : message->accepted) {
    accepted.add({one.component, one.topic, core::kindOf(one.kind), one.together,
                  fromRosTime(one.at), one.by});
  }
  return accepted;
}

}  // namespace self_awareness::ros1
