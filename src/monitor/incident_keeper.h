#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "node/file_writer.h"
#include "part.h"
#include "recorder_folder.h"
#include "self_awareness/Incidents.h"
#include "self_awareness/core/verdict/alarm.h"
#include "self_awareness/core/verdict/incident.h"
#include "self_awareness/core/verdict/source_graph.h"

namespace self_awareness {

/// Folds alarms and suspicions into incidents, and keeps the last ones in a file, for a year and
/// other starts of the monitor. The file is in the folder of the flight recorder, also where
/// nothing is recorded.
///
/// Belongs to the thread that judges; a thread of its own waits for the disk.
class IncidentKeeper : public Part {
 public:
  /// An alarm of the same cause so long after the last one is a repetition of it [ns].
  static constexpr std::int64_t kRepeatsWithin = 600'000'000'000;
  /// Near misses reach the file so long after each other at least [ns of steady time]: alarms do
  /// at once.
  static constexpr std::int64_t kNearMissesEvery = 60'000'000'000;

  /// @param publish called when an incident is opened, has grown, or is over
  IncidentKeeper(RecorderFolder folder,
                 std::function<void(const self_awareness::Incidents&)> publish);

  /// Reads the file: to be called first. What is open there is known no more, unless its alarm
  /// stands again. A file that is damaged is named in the log, and is written anew with the next
  /// incident.
  /// @param standing id of the alarm that stands since before the start; none: none does
  void restore(std::optional<std::uint64_t> standing);
  /// An alarm or a suspicion began, has changed, or is over.
  /// @param graph whose messages reach whom
  /// @param recording path of the file with its events; empty: there is none
  /// @param model path of the model that judges
  void add(const core::Alarm& alarm, const core::SourceGraph& graph, const std::string& recording,
           const std::string& model);
  /// Something was unusual, and is over. @param alarm without a level
  void addNearMiss(const core::Alarm& alarm);
  void onStart(const Session& session, const std::string& path) override;
  void onAlarm(const ros1::AlarmState& alarm) override;
  void onTick(const Moment& now) override;
  void onReport(MonitorState& state) override;
  /// Nobody watches what is open from now on. Writes what is not written yet, and waits for the
  /// disk.
  void finish() override;

  /// The last incidents.
  const self_awareness::Incidents& incidents() const { return incidents_; }
  /// Why the file could not be written; empty: it could.
  std::string error() const { return writer_.report().error; }

 private:
  struct Source {
    std::string recording;
    std::string model;
  };

  void write();

  const RecorderFolder folder_;
  const std::string path_;
  const std::function<void(const self_awareness::Incidents&)> publish_;
  const Session* session_ = nullptr;  // that judges; null: none does yet
  std::string model_;                 // path of its file
  core::Incidents folded_;
  std::map<std::uint64_t, Source> sources_;  // by id of the incident
  self_awareness::Incidents incidents_;
  bool written_ = true;
  Moment now_;                   // of the last tick
  std::int64_t written_at_ = 0;  // [ns of steady time]
  FileWriter writer_;
};

}  // namespace self_awareness
