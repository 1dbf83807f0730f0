#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "self_awareness/SelfAwareness.h"
#include "self_awareness/StandingAlarm.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/verdict/alarm.h"
#include "self_awareness/core/verdict/detector.h"

namespace self_awareness::ros1 {

/// What a verdict on its own does not know; what is empty is left out.
struct Circumstances {
  std::string load;       ///< of the machine, in words
  std::string recording;  ///< path of the file that holds the events of the alarm
};

/// What AlarmState::standDown() says where ROS time was set.
constexpr char kClockWasSet[] = "settling: ROS time was set";

/// To whom AlarmState says what it does.
struct AlarmHandlers {
  using Handler = std::function<void(const self_awareness::SelfAwareness&)>;
  /// Called with every window: ~status.
  Handler on_status = [](const auto& /*status*/) {};
  /// Called with each change of the level, and when an alarm names further components, or
  /// another one is to blame: ~alarm.
  Handler on_alarm = [](const auto& /*alarm*/) {};
  /// Called after each change: /diagnostics cannot wait for the next heartbeat.
  std::function<void()> on_diagnostics = [] {};
};

/// What the monitor says now, and when it says so; live and of a recording alike: the verdict on
/// the last window, and the alarm or suspicion that stands, with its suspects, its evidence, and
/// since when.
///
/// This is the one place where the level is kept. The detector decides with which window it
/// changes; what was said stands until then, or until standDown() takes it back.
class AlarmState {
 public:
  explicit AlarmState(AlarmHandlers handlers = {}) : handlers_(std::move(handlers)) {}

  /// Takes in the verdict on the next window. An alarm keeps the suspects and the evidence of the
  /// last window that had any.
  /// @param vocabulary that the suspects' ids are of
  /// @param window length [ns]
  void add(const core::Verdict& verdict, const core::Vocabulary& vocabulary, std::int64_t window,
           const Circumstances& circumstances = {});
  /// Goes on with an alarm of before the start, whose kind is one.
  /// @param before as it was kept
  /// @param suspects of it, the most likely first
  void resume(const self_awareness::StandingAlarm& before, std::vector<core::Suspect> suspects);
  /// Takes back what stands, for another reason than a window: there is nothing abnormal any more.
  /// @param message the reason
  /// @param now ROS time [ns]
  void standDown(const std::string& message, std::int64_t now);
  /// Forgets what was said of the last window, since another model judges from now on; an alarm
  /// stands until standDown().
  void forgetWindow();

  /// The alarm or the suspicion that stands, as a value; none: nothing does.
  const std::optional<core::Alarm>& standing() const { return alarms_.standing(); }
  /// The alarm or the suspicion that ended with the last add() or standDown(); none: nothing did.
  const std::optional<core::Alarm>& ended() const { return ended_; }
  /// Whether there is an alarm or a suspicion.
  bool stands() const { return message_.level != self_awareness::SelfAwareness::OK; }
  /// Whether anything was said since the start, or since forgetWindow().
  bool spoken() const { return !message_.message.empty(); }
  /// End of the window with which the level changed last [ns].
  std::int64_t since() const { return level_since_; }
  /// How long an alarm or a suspicion has stood [s], at the ROS time `now` [ns].
  double standsFor(std::int64_t now) const;
  /// Path of the file that holds the events of the alarm that was raised last; empty: there is
  /// none.
  const std::string& recording() const { return recording_; }
  /// All of it, as it is published.
  const self_awareness::SelfAwareness& message() const { return message_; }

 private:
  /// Takes over what the verdict says.
  void take(const core::Verdict& verdict, const core::Vocabulary& vocabulary, std::int64_t window,
            const Circumstances& circumstances);
  /// Says which alarm the message is about.
  void tell(const std::optional<core::Alarm>& alarm);

  const AlarmHandlers handlers_;
  core::Alarms alarms_;
  std::optional<core::Alarm> ended_;
  self_awareness::SelfAwareness message_;
  std::string recording_;
  // What is wrong with what components share, in words, of the last window that had evidence.
  std::string shared_;
  std::int64_t level_since_ = 0;  // end of the window with which the level changed last [ns]
};

}  // namespace self_awareness::ros1
