#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "alarm_state.h"
#include "self_awareness/SelfAwareness.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/verdict/detector.h"

namespace self_awareness::ros1 {

/// What standDown() says where ROS time was set.
constexpr char kClockWasSet[] = "settling: ROS time was set";

/// Decides what is said of a verdict, and when; live and of a recording alike.
class Announcer {
 public:
  struct Handlers {
    /// Called with every window: ~status.
    std::function<void(const self_awareness::SelfAwareness&)> on_status;
    /// Called with each change of the level, and when an alarm names further components, or
    /// another one is to blame: ~alarm.
    std::function<void(const self_awareness::SelfAwareness&)> on_alarm;
    /// Called after each change: /diagnostics cannot wait for the next heartbeat.
    std::function<void()> on_diagnostics;
  };

  explicit Announcer(Handlers handlers);

  /// Says what the verdict on the next window is. The arguments are those of AlarmState::add().
  void add(const core::Verdict& verdict, const core::Vocabulary& vocabulary, std::int64_t window,
           const Circumstances& circumstances = {});
  /// Says that an alarm of before the start stands, as AlarmState::resume().
  void resume(const self_awareness::StandingAlarm& before, std::vector<core::Suspect> suspects);
  /// Says that what stood is over, as AlarmState::standDown().
  void standDown(const std::string& message, std::int64_t now);
  /// As AlarmState::forgetWindow().
  void forgetWindow() { alarm_.forgetWindow(); }

  const AlarmState& alarm() const { return alarm_; }

 private:
  const Handlers handlers_;
  AlarmState alarm_;
};

}  // namespace self_awareness::ros1
