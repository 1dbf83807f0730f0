#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "self_awareness/core/stream/windows.h"
#include "self_awareness/core/verdict/judge.h"
#include "self_awareness/core/verdict/persistence.h"

namespace self_awareness::core {

/// What is said of one window.
struct Verdict {
  const Window* window = nullptr;   ///< valid during the handler's call
  std::optional<double> score;      ///< low is abnormal; none: nothing is said of the window
  std::optional<double> threshold;  ///< s*; none: not calibrated
  bool abnormal = false;            ///< eq. 5, or silence, or unknown events that are an error
  bool settling = false;            ///< too early to alarm; the window is not held against anyone
  bool alarm = false;               ///< the alarm stands
  bool suspicion = false;           ///< no alarm, but something was abnormal of late
  bool changed = false;             ///< the alarm or the suspicion began or ended with this window
  std::string evidence;             ///< of an abnormal or suspicious window, in words
  std::vector<Suspect> suspects;    ///< of an abnormal window that is not settling, best first
};

/// What is thought of events never seen in training: somebody may have plugged in a joystick.
enum class UnknownEvents { kIgnore, kWarn, kError };

/// The way of an event to an alarm, the same live and from a bag: window, judgement, persistence
/// (docs/method.md, section 4).
class Detector : private WindowObserver {
 public:
  struct Parameters {
    Persistence::Parameters persistence;
    std::int64_t settle_time = 5000000000;  ///< without alarms after the first event [ns]
    bool silence_is_abnormal = true;  ///< paper: a window without events scores 0, else nothing
    UnknownEvents unknown = UnknownEvents::kWarn;  ///< a suspicion, or an alarm at once

    /// @throw std::invalid_argument if a value is out of range.
    void validate() const;
  };
  using Handler = std::function<void(const Verdict&)>;

  /// @param window length [ns]
  /// @param handler called with the verdict of every window in turn; must not call back
  /// @throw std::invalid_argument if a parameter is out of range
  Detector(std::unique_ptr<Judge> judge, std::int64_t window, const Parameters& parameters,
           Handler handler);

  /// The next event. Where the clock was set since the last one, all starts afresh.
  /// @return false if it was: what was open is lost, and the recording starts here.
  bool add(const Event& event);
  /// The time is `now` [ns], whether something came or not: windows that are over are judged.
  void advance(std::int64_t now);
  /// The recording ends: the open window is judged.
  void finish();

  /// Forgets delays, windows and the alarm: the next event is the first.
  void restart();
  /// Lets settle_time pass without raising an alarm, from `now` [ns] on; one that stands, stands.
  void settle(std::int64_t now);
  /// Forgets the alarm and the windows that led to it; the delays go on.
  void clearAlarm();

  /// Whether an event has come since the start.
  bool started() const { return windows_.lastStamp().has_value(); }

 private:
  ObservedEvent observe(const Event& event) override { return judge_->add(event); }
  void close(const Window& window, std::int64_t end) override;
  void onClockStep() override;

  std::unique_ptr<Judge> judge_;
  Parameters parameters_;
  Handler handler_;
  Windows windows_;
  Persistence persistence_;
  bool suspicion_ = false;          // stands
  std::int64_t suspicious_at_ = 0;  // end of the last window that was [ns], while it stands
  std::int64_t settled_at_ = 0;     // [ns], valid once started
};

}  // namespace self_awareness::core
