#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::ros1 {

/// What was heard since the last report, and from whom.
struct HeardReport {
  struct Component {
    std::optional<double> last_heard;     ///< seconds ago; none: not since the start
    double rate = 0;                      ///< events a second, since the last report
    std::map<std::string, double> rates;  ///< by topic [Hz], in the last 10 to 20 s
  };

  std::map<std::string, Component> components;  ///< of the model, by core::componentOf()
  double rate = 0;                              ///< events a second, since the last report
  std::size_t known_types = 0;    ///< event types of the model that were heard since it was loaded
  std::size_t unknown_types = 0;  ///< others that were heard since then
  double cpu_share = 0;  ///< processor time of the whole process, in cores, since the last report
  std::uint64_t dropped = 0;        ///< messages, since the start
  std::uint64_t newly_dropped = 0;  ///< messages, since the last report
  std::uint64_t clock_steps = 0;    ///< times that ROS time was set, since the start
};

/// Counts what is heard, for one report after the other.
class HeardTally {
 public:
  /// What the clocks say at one moment [ns].
  struct Moment {
    std::int64_t ros = 0;
    std::int64_t steady = 0;
    std::int64_t cpu = 0;  ///< of all threads of the process: CLOCK_PROCESS_CPUTIME_ID
  };

  explicit HeardTally(const Moment& now)
      : before_(now.steady), since_(now.steady), reported_at_(now) {}

  /// From now on events are those of another model: nothing was heard of its components yet.
  /// @param types of the model, by their ids
  void setTypes(const std::vector<core::EventType>& types);
  /// An event was heard. An id that the model does not know counts for no component.
  void add(const core::Event& event);
  /// ROS time was set: when a component was last heard means nothing any more.
  void onClockStep();

  /// Seconds since the last report. @param now steady time [ns]
  double sinceReport(std::int64_t now) const;
  /// Reports, and begins to count for the next report.
  /// @param dropped messages since the start
  HeardReport report(const Moment& now, std::uint64_t dropped);

 private:
  struct Component {
    std::string name;
    std::optional<std::int64_t> last_heard;  // ROS time [ns]
    std::uint64_t events = 0;                // since the last report
  };

  struct Topic {
    std::string name;
    std::size_t component = 0;  // index
    std::uint64_t before = 0;   // events, from before_ to since_
    std::uint64_t events = 0;   // from since_ on
  };

  std::vector<Component> components_;
  std::vector<Topic> topics_;
  std::vector<std::size_t> topic_of_;  // index of the topic, by event id of the model
  std::int64_t before_ = 0;            // steady time [ns]
  std::int64_t since_ = 0;
  std::vector<bool> heard_types_;  // by event id
  std::size_t known_types_ = 0;
  std::size_t unknown_types_ = 0;
  std::uint64_t events_ = 0;  // since the last report
  std::uint64_t clock_steps_ = 0;
  std::uint64_t reported_drops_ = 0;
  Moment reported_at_;
};

}  // namespace self_awareness::ros1
