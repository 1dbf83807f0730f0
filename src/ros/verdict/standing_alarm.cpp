#include "standing_alarm.h"

#include <rosbag/exceptions.h>

#include <boost/filesystem/operations.hpp>
#include <cstdint>
#include <limits>
#include <new>
#include <stdexcept>

#include "../bag/bag_index.h"
#include "../bag/stored_messages.h"
#include "../bag/version_of_bag.h"
#include "self_awareness/ros/bag/bag_reader.h"
#include "self_awareness/ros/bag/bag_writer.h"
#include "self_awareness/ros/file_version.h"
#include "self_awareness/ros/output_file.h"
#include "self_awareness/ros/ros_time.h"

namespace self_awareness::ros1 {
namespace {

constexpr char kTopic[] = "/standing_alarm";
// Many times what an alarm needs [bytes].
constexpr std::uint64_t kLargestFile = 1 << 20;

void check(bool true_of_it, const char* problem) {
  if (!true_of_it) {
    throw std::invalid_argument(problem);
  }
}

void checkContent(const self_awareness::StandingAlarm& standing) {
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

self_awareness::StandingAlarm read(const std::string& path) {
  const std::optional<BagIndex> index = readIndexOfFormat2(path);
  check(index.has_value(), "it is no bag");
  checkedVersion(path, *index, kStandingAlarmFile);
  StoredMessages messages(path, *index, kLargestFile);
  std::optional<self_awareness::StandingAlarm> found;
  for (const BagIndexEntry& entry : index->entries) {
    if (holds<self_awareness::StandingAlarm>(index->connections[entry.connection])) {
      check(!found, "it holds several alarms");
      found = messages.read<self_awareness::StandingAlarm>(entry);
    }
  }
  check(found.has_value(), "it holds no alarm");
  checkContent(*found);
  return *found;
}

}  // namespace

void writeStandingAlarm(const self_awareness::StandingAlarm& standing, const std::string& path) {
  OutputFile file(path);
  BagWriter bag(file.temporary(), BagWriter::Chunks::kOfOneMessage, path);
  const ros::Time stamp = std::max(standing.alarm.header.stamp, ros::TIME_MIN);
  bag.write({kVersionTopic}, stamp, versionOf(kStandingAlarmFile));
  bag.write({kTopic}, stamp, standing);
  bag.close();
  file.complete();
}

std::optional<self_awareness::StandingAlarm> readStandingAlarm(const std::string& path) {
  boost::system::error_code error;
  if (!boost::filesystem::exists(path, error)) {
    return std::nullopt;
  }
  try {
    // To open a pipe would wait for its writer.
    check(boost::filesystem::is_regular_file(path, error) &&
              boost::filesystem::file_size(path, error) <= kLargestFile,
          "it is no such file");
    const self_awareness::StandingAlarm standing = read(path);
    return standing.alarm.level == self_awareness::SelfAwareness::ERROR ? std::optional(standing)
                                                                        : std::nullopt;
  } catch (const rosbag::BagException& problem) {
    throw BagError(path + ": the alarm in it is damaged (" + problem.what() + ")");
  } catch (const std::invalid_argument& problem) {
    throw BagError(path + ": the alarm in it is damaged (" + problem.what() + ")");
  } catch (const std::bad_alloc&) {
    throw BagError(path + ": the alarm in it is damaged");
  }
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
      suspect.since = fromRosTime(message.since);
      suspect.reason.kind = *kind;
      suspect.reason.words = message.reason;
      suspects.push_back(suspect);
    }
  }
  return suspects;
}

}  // namespace self_awareness::ros1
