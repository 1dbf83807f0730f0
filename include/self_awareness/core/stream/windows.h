#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::core {

/// Default length of a window [ns] (paper, section V-B).
constexpr std::int64_t kDefaultWindow = kNanosecondsPerSecond / 10;

/// Windows of a model are no shorter and no longer [ns]: a silence is judged window by window.
constexpr std::int64_t kShortestWindow = kNanosecondsPerSecond / 1000;
constexpr std::int64_t kLongestWindow = 86400 * kNanosecondsPerSecond;

/// Start [ns] of the window in which a stamp [ns] lies: windows start at the multiples of `length`
/// [ns].
std::int64_t floorToGrid(std::int64_t stamp, std::int64_t length);

/// An event, and what was known when it came.
struct ObservedEvent {
  Event event;
  bool unknown = false;             ///< never seen in training
  std::optional<std::int64_t> gap;  ///< delay since the last event of the same type [ns]
};

/// One window of eq. 2 (docs/method.md, section 1.3).
struct Window {
  std::int64_t start = 0;  ///< [ns], on the absolute grid of window lengths
  std::vector<ObservedEvent> events;

  /// Number of its events of types that training never saw.
  std::size_t unknown() const;
};

/// Takes in the events of a recording and looks at its windows, one after the other.
class WindowObserver {
 public:
  virtual ~WindowObserver() = default;

  /// Takes in the next event. All windows that end at or before it are closed already.
  /// @return none: it is no event of a window, but tells the mode of the robot (mode.h)
  virtual std::optional<ObservedEvent> observe(const Event& event) = 0;
  /// Looks at a window that is over.
  /// @param end up to where the window is known [ns]: its own end, or the recording's if that is
  /// earlier
  virtual void close(const Window& window, std::int64_t end) = 0;
  /// Forgets what was seen, since the clock was set (clock.h).
  virtual void onClockStep() = 0;
};

/// Cuts the events of a recording into windows that do not overlap (docs/method.md, section 1.3):
/// window k holds k * length <= t < (k + 1) * length. Windows without events are closed, too.
class Windows {
 public:
  /// @param length [ns], > 0
  /// @param observer must outlive the windows, and not call them back
  /// @throw std::invalid_argument if the length is out of range
  Windows(std::int64_t length, WindowObserver& observer);

  /// Closes the windows that end at or before the event, hands it to the observer, and counts it.
  /// An event that comes late, after its window was closed, counts in the open one. If the clock
  /// was set since the last event, the open window is dropped, and a new recording starts with
  /// this event.
  /// @return false if the clock was set
  bool add(const Event& event);
  /// Closes all windows that end at or before `now` [ns]; silence has windows, too.
  void advance(std::int64_t now);
  /// Ends the recording: closes the open window, if there is one. The next event starts a new
  /// recording.
  void finish();
  /// Drops the open window; the next event opens a new one.
  void restart();

  std::int64_t length() const { return length_; }
  /// Stamp of the last event [ns]; none before the first.
  const std::optional<std::int64_t>& lastStamp() const { return last_stamp_; }

 private:
  std::int64_t length_;
  WindowObserver& observer_;
  std::optional<Window> open_;
  std::optional<std::int64_t> last_stamp_;  // [ns]
  std::int64_t now_ = 0;                    // latest time known [ns], while a window is open
};

}  // namespace self_awareness::core
