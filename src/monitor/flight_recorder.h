#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "file_writer.h"
#include "recorder_folder.h"
#include "self_awareness/EventLog.h"
#include "self_awareness/EventType.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/stream/waiting.h"
#include "self_awareness/ros/bag/event_log_packer.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/graph.h"

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
/// written by the thread of a FileWriter. Times "now" are steady time [ns], others ROS time [ns].
class FlightRecorder {
 public:
  /// What a file says besides its events.
  struct Source {
    ros1::EncodingRules encoding;
    std::shared_ptr<const ros1::Graph> graph;  ///< none: not known
  };
  struct Report {
    double seconds = 0;     ///< of events in memory
    std::size_t bytes = 0;  ///< of memory, also of files that are not yet written
    FileWriter::Report files;
  };

  /// @param source called when a file is asked for
  FlightRecorder(const RecorderParameters& parameters, std::function<Source()> source);
  FlightRecorder(const FlightRecorder&) = delete;
  FlightRecorder& operator=(const FlightRecorder&) = delete;

  /// Whether there is a recorder: not with a duration of 0.
  bool enabled() const { return duration_ > 0; }
  /// Takes in the next event.
  /// @param vocabulary that its id is of; it may grow until restart()
  void add(const core::Event& event, const core::Vocabulary& vocabulary);
  /// Takes in how the machine was.
  void add(const core::Waiting& waiting);
  /// Nothing else was heard before `ros_now`. Writes the file of an alarm when its time has come.
  void advance(std::int64_t ros_now, std::int64_t now);
  /// The events to come have nothing to do with those before: ROS time was set, or another model
  /// encodes them. A file that waits for what follows is written as it is.
  void restart();

  /// An alarm was raised: what was heard, and what follows, will be in a file, which stays until
  /// onAlarmOver(). Alarms that are raised meanwhile are in the same one.
  /// @return path of the file; empty without a recorder
  std::string onAlarm(std::int64_t now);
  /// An alarm of before the start stands: its file stays until onAlarmOver().
  void onAlarmResumed(const std::string& path) { kept_ = path; }
  /// Writes what was heard up to now.
  /// @return path of the file; none if nothing was heard
  std::optional<std::string> dump();
  /// The alarm that was raised last is over: its file may be removed for newer ones.
  void onAlarmOver() { kept_.clear(); }
  /// The program ends: writes what waits, or what was heard if an alarm stands, and waits for the
  /// disk. Nothing is recorded after it; a second call does nothing.
  void finish(bool alarm_stands);

  Report report() const;

 private:
  using Part = std::shared_ptr<const self_awareness::EventLog>;
  struct Pending {
    std::string path;
    std::int64_t due = 0;
  };

  void keep(self_awareness::EventLog part);
  void forgetOldest();
  bool heardAnything() const { return first_.has_value(); }
  /// Path of a new file; no two have the same.
  std::string newPath(RecorderFolder::Cause cause);
  /// Hands all that is kept to the writer.
  void write(const std::string& path);

  const std::int64_t duration_;  // [ns]
  const std::int64_t after_;     // [ns]
  const std::size_t most_bytes_;
  const std::function<Source()> source_;
  const RecorderFolder folder_;
  ros1::EventLogPacker packer_;
  std::deque<Part> parts_;
  std::size_t bytes_ = 0;              // of the parts
  std::optional<std::int64_t> first_;  // where what is kept begins; none: nothing was heard
  std::int64_t last_ = 0;              // up to where all was heard
  std::vector<self_awareness::EventType> forgotten_types_;  // of parts that were forgotten
  std::optional<Pending> pending_;
  std::string kept_;           // path of the file of an alarm that stands; empty: none does
  std::int64_t named_at_ = 0;  // wall time that the last file is named by [ns]
  bool finished_ = false;
  FileWriter writer_;  // last: it writes what the others have handed over
};

}  // namespace self_awareness
