#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::core {

/// Length of a window where nothing else is asked for [ns]: that of the paper, section V-B.
constexpr std::int64_t kDefaultWindow = kNanosecondsPerSecond / 10;

/// Start of the window [ns] that a stamp [ns] lies in, on the absolute grid of window lengths
/// [ns].
std::int64_t floorToGrid(std::int64_t stamp, std::int64_t length);

/// An event with what was seen when it came.
struct ObservedEvent {
  Event event;
  bool unknown = false;             ///< never seen in training
  std::optional<std::int64_t> gap;  ///< delay since the last event of the same type [ns]
};

/// One window of eq. 2.
struct Window {
  std::int64_t start = 0;  ///< [ns], on the absolute grid of window lengths
  std::vector<ObservedEvent> events;

  /// How many of its events were never seen in training.
  std::size_t unknown() const;
};

/// Who takes in the events of a recording and looks at its windows, each in its turn.
class WindowObserver {
 public:
  virtual ~WindowObserver() = default;

  /// The next event. All windows that end before it were closed.
  virtual ObservedEvent observe(const Event& event) = 0;
  /// A window is over. @param end of what is known of it [ns]: its own end, or where the recording
  /// ends within it
  virtual void close(const Window& window, std::int64_t end) = 0;
  /// The clock was set (clock.h): what was seen before says nothing of what follows.
  virtual void onClockStep() = 0;
};

/// Walks through the events of a recording and cuts them into windows that do not overlap: window
/// k holds k * length <= t < (k + 1) * length. Windows without events are closed like any other.
class Windows {
 public:
  /// @param length [ns], > 0
  /// @param observer must outlive the windows, and not call them back
  /// @throw std::invalid_argument
  Windows(std::int64_t length, WindowObserver& observer);

  /// Closes the windows that end at or before the event, hands it to the observer, and counts it.
  /// An event that comes late, after its window was closed, counts in the open one. Where the
  /// clock was set since the last event, the open window is lost, and the walk starts afresh.
  /// @return false if the clock was set
  bool add(const Event& event);
  /// Closes all windows that end at or before `now` [ns]; silence has windows too.
  void advance(std::int64_t now);
  /// The recording ends: closes the open window, if there is one. The next event starts afresh.
  void finish();
  /// Forgets the open window; the grid starts again with the next event.
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
