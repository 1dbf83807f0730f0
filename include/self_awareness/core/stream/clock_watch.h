#pragma once

#include <cstdint>
#include <optional>

namespace self_awareness::core {

/// Whether ROS time was set between two looks at it and at the steady clock, by how far both went
/// meanwhile [ns].
/// @param simulated whether ROS time comes from /clock, which may run at any pace
bool wasSet(std::int64_t ros_advance, std::int64_t steady_advance, bool simulated);

/// Notices that ROS time was set: NTP stepped the wall clock, a bag loops, a simulation was reset;
/// that it stands still; and that nobody looked for a while. Compares how far ROS time and steady
/// time went between two looks.
class ClockWatch {
 public:
  /// A look at both clocks at one moment [ns].
  /// @param simulated as of wasSet()
  /// @return true if ROS time was set since the last look
  bool look(std::int64_t ros_now, std::int64_t steady_now, bool simulated);

  /// How long simulated time has stood still, at the last look [ns of steady time].
  std::int64_t standsStillFor() const { return last_ ? last_->steady_time - advanced_at_ : 0; }
  /// Time between the last two looks [ns of steady time].
  std::int64_t pause() const { return pause_; }

  /// Whether an event with this stamp [ns] belongs to the time before the clock was set last: it
  /// waited in a queue while the clock was set, and its delays mean nothing.
  bool isStale(std::int64_t stamp) const;

 private:
  struct Look {
    std::int64_t ros_time;
    std::int64_t steady_time;
  };
  std::optional<Look> last_;
  std::int64_t advanced_at_ = 0;  // steady time of the last look that found ROS time changed [ns]
  std::int64_t pause_ = 0;        // [ns]
  std::optional<std::int64_t> set_at_;  // ROS time right after the last step [ns]
};

}  // namespace self_awareness::core
