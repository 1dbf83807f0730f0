#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "self_awareness/core/blame.h"
#include "self_awareness/core/persistence.h"
#include "self_awareness/core/scorer.h"
#include "self_awareness/core/windows.h"

namespace self_awareness::core {

/// What is said of one window.
struct Verdict {
  const Window* window = nullptr;   ///< valid during the handler's call
  std::optional<double> score;      ///< eq. 2; none for a window without events
  std::optional<double> threshold;  ///< s*; none: not calibrated
  bool abnormal = false;            ///< eq. 5, or silence
  bool settling = false;            ///< too early to alarm; the window is not held against anyone
  bool alarm = false;               ///< the alarm stands
  bool changed = false;             ///< the alarm was raised or cleared by this window
  std::vector<Suspect> suspects;    ///< of an abnormal window that is not settling, best first
};

/// The way of an event to an alarm, the same live and from a bag: score, window, threshold,
/// persistence, blame.
class Detector {
 public:
  struct Parameters {
    Persistence::Parameters persistence;
    std::int64_t settle_time = 5000000000;  ///< without alarms after the first event [ns]
    bool silence_is_abnormal = true;        ///< a window without events scores 0, else nothing

    /// @throw std::invalid_argument if a value is out of range.
    void validate() const;
  };
  using Handler = std::function<void(const Verdict&)>;

  /// @param window length [ns]
  /// @param threshold s*; none: windows are scored and never abnormal
  /// @param handler called with the verdict of every window in turn; must not call back
  Detector(std::shared_ptr<const Model> model, std::int64_t window,
           std::optional<double> threshold, const Parameters& parameters, Handler handler);

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
  void clearAlarm() { persistence_.clear(); }

  const Scorer& scorer() const { return scorer_; }
  const Blame& blame() const { return blame_; }
  /// Whether an event has come since the start.
  bool started() const { return last_stamp_.has_value(); }

 private:
  void judge(const Window& window);

  std::optional<double> threshold_;
  Parameters parameters_;
  Handler handler_;
  Scorer scorer_;
  Windows windows_;
  Persistence persistence_;
  Blame blame_;
  std::optional<std::int64_t> last_stamp_;  // of an event [ns]
  std::int64_t settled_at_ = 0;             // [ns], valid once started
};

}  // namespace self_awareness::core
