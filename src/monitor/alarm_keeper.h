#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "node/file_writer.h"
#include "part.h"
#include "recorder_folder.h"
#include "self_awareness/SelfAwareness.h"
#include "self_awareness/StandingAlarm.h"

namespace self_awareness {

/// Keeps what the alarm is in a file: a monitor that crashed, or was started again for another
/// reason, goes on with what stood. The file is in the folder of the flight recorder, also where
/// nothing is recorded, and there is none before the first alarm.
///
/// Belongs to the thread that judges; a thread of its own waits for the disk.
class AlarmKeeper : public Part {
 public:
  /// @param run_id of the roscore: alarms of another one are of another start of the robot
  AlarmKeeper(RecorderFolder folder, std::string run_id);

  /// Another model judges from now on.
  /// @param content number over what it is (Session::content())
  void setModel(std::uint64_t content);
  /// What stood when the monitor ended. A file that is damaged is named in the log, and stays.
  /// @return none: nothing, or it was another start of the robot, or another model that judged
  std::optional<self_awareness::StandingAlarm> read();
  /// The alarm has changed.
  /// @param alarm as it is published; of another level than ERROR: nothing stands
  /// @param since end of the window that raised it [ns]
  /// @param recording file with its events
  void keep(const self_awareness::SelfAwareness& alarm, std::int64_t since,
            const std::string& recording);
  void onStart(const Session& session, const std::string& path) override;
  void onAlarm(const ros1::AlarmState& alarm) override;
  void onReport(MonitorState& state) override;
  /// Waits for the disk.
  void finish() override { writer_.finish(); }
  /// Why the file could not be written; empty: it could.
  std::string error() const { return writer_.report().error; }

 private:
  const RecorderFolder folder_;
  const std::string path_;
  const std::string run_id_;
  std::uint64_t model_ = 0;  // 0: there is none
  bool read_ = false;        // the file was
  bool stands_ = false;      // by the file, as it is written or will be
  FileWriter writer_;
};

}  // namespace self_awareness
