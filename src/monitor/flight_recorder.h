#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <std_srvs/Trigger.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "node/file_writer.h"
#include "part.h"
#include "recorder_folder.h"
#include "self_awareness/EventLog.h"
#include "self_awareness/EventType.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/stream/waiting.h"
#include "self_awareness/ros/bag/event_log_writer.h"

namespace self_awareness {

/// Parameters of the flight recorder; config/self_awareness.yaml explains each to its user.
struct RecorderParameters {
  double duration = 300;  ///< ~recorder/duration [s]; 0: no recorder
  double after = 10;      ///< ~recorder/after [s]
  std::string directory = "$ROS_HOME/self_awareness/$NAME";  ///< ~recorder/directory
  int files = 20;                                            ///< ~recorder/files: most of them
  int disk = 200;    ///< ~recorder/disk: most of all files [MB]
  int memory = 32;   ///< ~recorder/memory: most for events [MB]
  std::string name;  ///< full name of the monitor
};

/// Where its files are, and those of the alarm that stands (AlarmKeeper) and of the last incidents
/// (IncidentKeeper).
RecorderFolder folderOf(const RecorderParameters& parameters);

/// Keeps the events of the last minutes in memory, and writes them as an event log when there is a
/// reason to. It belongs to the thread that judges, which packs events and no more: files are
/// written by the thread of a FileWriter. Times are ROS time [ns], if nothing else is said.
class FlightRecorder : public Part {
 public:
  struct Report {
    double seconds = 0;     ///< of events in memory
    std::size_t bytes = 0;  ///< of memory, also of files that are not yet written
    FileWriter::Report files;
  };

  /// @param source called when a file is asked for
  FlightRecorder(const RecorderParameters& parameters, std::function<ros1::LogSource()> source);

  /// Whether there is a recorder: not with a duration of 0.
  bool enabled() const { return duration_ > 0; }
  std::vector<ros::ServiceServer> advertise(ros::NodeHandle& private_node_handle) override;
  void onEvent(const core::Event& event, const core::Vocabulary& vocabulary) override;
  void onWaiting(const core::Waiting& waiting) override;
  /// Writes the file of an alarm when its time has come.
  void onTick(const Moment& now) override;
  /// A file that waits for what follows is written as it is.
  void onCut(Cut why) override;
  /// Where an alarm is raised, what was heard, and what follows, will be in a file. Alarms that
  /// are raised meanwhile are in the same one.
  void onVerdict(core::Verdict& verdict, ros1::Circumstances& circumstances) override;
  /// The file of an alarm stays as long as the alarm stands.
  void onAlarm(const ros1::AlarmState& alarm) override;
  void onReport(MonitorState& state) override;
  /// Writes what waits, or what was heard if an alarm stands, and waits for the disk. A second
  /// call does nothing.
  void finish() override;

  /// Writes what was heard up to now.
  /// @return path of the file; none if nothing was heard
  std::optional<std::string> dump();

  Report report() const;

 private:
  struct Pending {
    std::string path;
    std::int64_t due = 0;
  };

  bool onDump(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void keep(self_awareness::EventLog part);
  void forgetOldest();
  bool heardAnything() const { return first_.has_value(); }
  /// Path of a new file; no two have the same.
  std::string newPath(const std::string& cause);
  /// Hands all that is kept to the writer.
  void write(const std::string& path);

  const std::int64_t duration_;  // [ns]
  const std::int64_t after_;     // [ns]
  const std::size_t most_bytes_;
  const std::function<ros1::LogSource()> source_;
  const RecorderFolder folder_;
  ros1::EventLogPacker packer_;
  std::deque<std::shared_ptr<const self_awareness::EventLog>> parts_;
  std::size_t bytes_ = 0;              // of the parts
  std::optional<std::int64_t> first_;  // where what is kept begins; none: nothing was heard
  std::int64_t last_ = 0;              // up to where all was heard
  std::vector<self_awareness::EventType> forgotten_types_;  // of parts that were forgotten
  std::optional<Pending> pending_;
  bool stands_ = false;        // an alarm
  std::string kept_;           // path of its file; empty: there is none
  std::int64_t now_ = 0;       // of the last tick [ns of steady time]
  std::int64_t named_at_ = 0;  // wall time that the last file is named by [ns]
  bool finished_ = false;
  FileWriter writer_;  // last: it writes what the others have handed over
};

}  // namespace self_awareness
