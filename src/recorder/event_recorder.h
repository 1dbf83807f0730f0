#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/service_server.h>
#include <std_srvs/Trigger.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "node/live_source.h"
#include "node/run_node.h"
#include "self_awareness/core/stream/lasting.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/ros/bag/event_log_writer.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/graph.h"

namespace self_awareness {

/// Records a robot's communication as event logs, by the same way that the monitor hears it.
///
/// **Parameters**, all private; one that is out of range ends the node, one that is unknown is a
/// warning.
/// - `~output` (string; default: normal): beginning of the files' paths; date, time and `.bag` are
///   added. A file that is written ends in `.bag.active`.
/// - `~split` (double, minutes; default: 30; 0.1 to 10000): length of a file; each is a recording.
/// - `~encoding` (namespace): how messages become events, as in config/encoding.yaml.
/// - `~subscribe` (string; default: used; used or all): topics to listen to: what a robot's node
///   listens to, or all that are published, which may wake publishers that work only while
///   somebody listens.
/// - `~min_space` (double, MB; default: 1000; 0 to 1e15): with less free space on the disk
///   nothing is recorded.
/// - `~robot_start` (double, seconds since 1970; default: now; 0 to 4294967295): when the robot
///   was started, for who starts the recorder more than once in a start of the robot.
/// - `~robot` (string; default: empty): the robot's name, for a model that is learned from several
///   robots (docs/robots.md). Empty: the recordings do not say it.
/// - `~diagnostics` (string; default: /diagnostics): topic of its status. If /diagnostics were
///   remapped, the recorder would not hear what the robot says there.
/// - `~poll_interval`, `~queue_size`, `~diagnostic_period`: as those of the monitor.
///
/// **Published topics**
/// - `/diagnostics`, or `~diagnostics`: one status, an error while nothing can be recorded.
/// - `~start` (self_awareness/EventLogStart): latched; how the recording that is written begins.
///   By this type, monitors know the recorder for one of this package, whatever its name is.
///
/// **Services**: `~finish` (std_srvs/Trigger): ends the file and the node.
///
/// **Recordings**: a new one begins with each file, and after ROS time was set. The robot is taken
/// to start with this node (but for `~robot_start`), and with its master.
class EventRecorder : public NodeProgram, public LiveSource::Listener {
 public:
  /// @param end called by ~finish; must not block
  /// @throw std::invalid_argument if a parameter is out of range
  EventRecorder(ros::NodeHandle node_handle, const ros::NodeHandle& private_node_handle,
                std::function<void()> end);
  ~EventRecorder() override;

  /// Ends the file.
  void finish() override;

 private:
  struct Parameters {
    std::string output = "normal";
    double split = 30;  // [min]
    ros1::EncodingRules encoding;
    double min_space = 1000;  // [MB]
    double robot_start = 0;   // wall time [s]
    std::string robot;        // its name; empty: not said
    LiveParameters live;
    std::string diagnostics = "/diagnostics";

    static Parameters load(const ros::NodeHandle& private_node_handle);
  };
  /// The file that is written.
  struct File {
    explicit File(const std::string& path);
    std::string path;  // when it is closed
    ros1::EventLogWriter log;
  };

  void onEvent(const core::Event& event) override;
  void onWaiting(const core::Waiting& waiting) override;
  void onClockSet(std::int64_t now) override;
  void onMasterRestart(std::int64_t now) override;
  void onTick(std::int64_t now) override;
  void onReport() override;
  bool onFinish(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);

  /// Begins a recording in a file of its own, if there is space.
  void begin(std::int64_t now);
  /// Ends the recording and its file.
  void end(std::int64_t now);
  /// Does something that writes; what goes wrong ends the file, and is told.
  void attempt(const std::function<void()>& write);
  std::string newPath() const;
  bool hasSpace() const;

  ros::CallbackQueue queue_;
  ros::NodeHandle private_node_handle_;
  const std::function<void()> end_;
  Parameters parameters_;
  core::Vocabulary vocabulary_;
  core::Lasting lasting_;  // each recording begins with it
  ros::Publisher diagnostics_;
  ros::Publisher start_publisher_;
  ros::ServiceServer finish_;

  std::int64_t robot_start_;    // wall time [ns]
  std::unique_ptr<File> file_;  // none: nothing is recorded
  std::optional<ros1::EventLogPacker> packer_;
  std::int64_t began_ = 0;                    // the file, steady time [ns]
  std::shared_ptr<const ros1::Graph> graph_;  // that was written to the file last
  bool finished_ = false;                     // nothing is recorded any more
  std::string problem_;                       // why nothing is recorded; empty: it is
  std::uint64_t events_ = 0;                  // since the start of the node
  std::uint64_t bytes_ = 0;                   // of the files that are complete
  std::size_t files_ = 0;                     // that are complete
  std::unique_ptr<LiveSource> live_;          // last: its listener uses all of the above
};

}  // namespace self_awareness
