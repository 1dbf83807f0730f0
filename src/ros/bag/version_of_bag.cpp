#include "version_of_bag.h"

#include <rosbag/exceptions.h>

#include <algorithm>
#include <stdexcept>

#include "../text.h"
#include "open_bag.h"
#include "self_awareness/EventLog.h"
#include "self_awareness/EventLogGraph.h"
#include "self_awareness/EventLogStart.h"
#include "self_awareness/ros/bag/bag_reader.h"
#include "stored_messages.h"

namespace self_awareness::ros1 {
namespace {

bool tellsVersion(const Connection& connection) {
  return connection.topic == kVersionTopic && holds<self_awareness::FileVersion>(connection);
}

/// The same, not checked against what this version reads.
self_awareness::FileVersion versionOfKind(const std::string& path, const BagIndex& index,
                                          const FileKind& kind) {
  const std::optional<self_awareness::FileVersion> version = versionOfBag(path, index);
  if (version && version->kind != kind.name) {
    throw BagError(path + ": not of the kind " + kind.name +
                   "; the file says that it is: " + printable(version->kind, kLongestQuote));
  }
  return version.value_or(firstVersionOf(kind));
}

bool holdNothingElse(const std::vector<Connection>& connections) {
  return !connections.empty() &&
         std::all_of(connections.begin(), connections.end(), [](const Connection& connection) {
           return isOfEventLog(connection) || holds<self_awareness::FileVersion>(connection);
         });
}

}  // namespace

bool tellVersion(const std::vector<Connection>& connections) {
  return std::any_of(connections.begin(), connections.end(), tellsVersion);
}

std::optional<self_awareness::FileVersion> versionOfBag(const std::string& path,
                                                        const BagIndex& index) {
  if (!tellVersion(index.connections)) {
    return std::nullopt;
  }
  const auto first =
      std::find_if(index.entries.begin(), index.entries.end(), [&](const BagIndexEntry& entry) {
        return tellsVersion(index.connections[entry.connection]);
      });
  if (first == index.entries.end()) {
    return std::nullopt;
  }
  try {
    return StoredMessages(path, index).read<self_awareness::FileVersion>(*first);
  } catch (const rosbag::BagException& error) {
    throw BagError(path + ": what it says of its version is damaged (" + error.what() + ")");
  } catch (const std::invalid_argument& error) {
    throw BagError(path + ": what it says of its version is damaged (" + error.what() + ")");
  } catch (const std::bad_alloc&) {
    throw BagError(path + ": what it says of its version is damaged");
  }
}

self_awareness::FileVersion checkedVersion(const std::string& path, const BagIndex& index,
                                           const FileKind& kind) {
  self_awareness::FileVersion version = versionOfKind(path, index, kind);
  const std::string problem = whyUnread(version, kind);
  if (!problem.empty()) {
    throw BagError(path + ": " + problem);
  }
  return version;
}

self_awareness::FileVersion readFileVersion(const std::string& path, const FileKind& kind) {
  return versionOfKind(path, openBag(path), kind);
}

bool isOfEventLog(const Connection& connection) {
  return holds<self_awareness::EventLogStart>(connection) ||
         holds<self_awareness::EventLog>(connection) ||
         holds<self_awareness::EventLogGraph>(connection);
}

bool mayBeEventLog(const std::vector<Connection>& connections) {
  return tellVersion(connections) || holdNothingElse(connections);
}

bool isEventLog(const std::string& path, const BagIndex& index) {
  if (!mayBeEventLog(index.connections)) {
    return false;
  }
  const std::optional<self_awareness::FileVersion> version = versionOfBag(path, index);
  return version
             ? version->kind == kEventLogFile.name &&
                   (version->format > kEventLogFile.format || holdNothingElse(index.connections))
             : holdNothingElse(index.connections);
}

}  // namespace self_awareness::ros1
