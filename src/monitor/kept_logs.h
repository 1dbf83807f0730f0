#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "node/file_writer.h"
#include "part.h"
#include "self_awareness/EventLog.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/stream/lasting.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/stream/waiting.h"
#include "self_awareness/ros/bag/event_log_writer.h"

namespace self_awareness {

/// Parameters of KeptLogs; config/self_awareness.yaml explains each to its user.
struct KeptLogsParameters {
  bool on = false;  ///< ~learn_more
  int disk = 500;   ///< ~learn_more_disk: most of all logs [MB]
};

/// Keeps event logs of normal operation, to learn more from (docs/learn.md). What is heard is
/// cut into stretches, each of which stays in memory until it is over: only what was normal all
/// the time is written. The oldest logs make room for new ones.
///
/// It belongs to the thread that judges; files are written by the thread of a FileWriter. Times
/// are ROS time [ns].
class KeptLogs : public Part {
 public:
  /// Length of a stretch [ns]; the last one before the end may be shorter.
  static constexpr std::int64_t kLongest = 1800 * core::kNanosecondsPerSecond;
  static constexpr std::int64_t kShortest = 10 * core::kNanosecondsPerSecond;
  /// Of the events in memory; a stretch that has more ends early.
  static constexpr std::size_t kMostBytes = 32000000;

  struct Report {
    std::uint64_t kept = 0;      ///< stretches
    std::uint64_t left_out = 0;  ///< stretches
    std::string why;             ///< the last one was left out; empty: none was
    FileWriter::Report files;
  };

  /// @param source called when a stretch is written
  /// @param robot_start when the robot was started: wall time [ns]
  KeptLogs(const KeptLogsParameters& parameters, std::function<ros1::LogSource()> source,
           std::int64_t robot_start);

  bool enabled() const { return parameters_.on; }
  /// Another model judges from now on. Its logs are in a folder beside it.
  /// @param path of the model
  /// @param calibrated else nobody can say what is normal, and nothing is kept
  void setModel(const std::string& path, bool calibrated);
  void onStart(const Session& session, const std::string& path) override;
  void onEvent(const core::Event& event, const core::Vocabulary& vocabulary) override;
  void onWaiting(const core::Waiting& waiting) override;
  void onTick(const Moment& now) override;
  /// The stretch is not normal operation, and will not be kept.
  /// @param why in words
  void leaveOut(const std::string& why);
  /// Ends the stretch.
  void onCut(Cut /*why*/) override { endStretch(); }
  /// The master was restarted: the robot is taken for started again.
  /// @param at wall time [ns]
  void onRobotStart(std::int64_t at);
  void onReport(MonitorState& state) override;
  /// Ends the stretch and waits for the disk.
  void finish() override;

  Report report() const;

 private:
  void endStretch();
  void write();

  const KeptLogsParameters parameters_;
  const std::function<ros1::LogSource()> source_;
  std::int64_t robot_start_;
  std::string folder_;                          // empty: nothing is kept
  std::optional<ros1::EventLogPacker> packer_;  // of the stretch; none: it has not begun
  std::vector<std::shared_ptr<const self_awareness::EventLog>> parts_;
  std::size_t bytes_ = 0;      // of the parts
  std::int64_t first_ = 0;     // of the stretch
  std::int64_t last_ = 0;      // up to where all of it was heard
  core::Lasting lasting_;      // each stretch begins with it
  std::string why_;            // it is not normal; empty: it is, so far
  std::int64_t named_at_ = 0;  // wall time that the last file is named by [ns]
  Report report_;
  bool finished_ = false;
  FileWriter writer_;  // last: it writes what the others have handed over
};

}  // namespace self_awareness
