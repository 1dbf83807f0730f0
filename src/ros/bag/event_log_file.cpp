#include "event_log_file.h"

#include <algorithm>
#include <optional>

#include "self_awareness/EventLog.h"
#include "self_awareness/EventLogGraph.h"
#include "self_awareness/EventLogStart.h"
#include "stored_messages.h"
#include "version_of_bag.h"

namespace self_awareness::ros1 {
namespace {

bool holdNothingElse(const std::vector<Connection>& connections) {
  return !connections.empty() &&
         std::all_of(connections.begin(), connections.end(), [](const Connection& connection) {
           return isOfEventLog(connection) || holds<self_awareness::FileVersion>(connection);
         });
}

}  // namespace

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
