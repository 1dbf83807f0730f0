#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::core {

/// Start of the window [ns] that a stamp [ns] lies in, on the absolute grid of window lengths
/// [ns].
std::int64_t floorToGrid(std::int64_t stamp, std::int64_t length);

/// An event with what the scorer found.
struct ScoredEvent {
  Event event;
  double score = 0;                 ///< s_j of eq. 3, 0 or more; 0 if the event is unknown
  bool unknown = false;             ///< never seen in training
  std::optional<std::int64_t> gap;  ///< delay since the last event of the same type [ns]
};

/// One window of eq. 2.
struct Window {
  std::int64_t start = 0;  ///< [ns], on the absolute grid of window lengths
  std::vector<ScoredEvent> events;

  /// Score of the window: the mean over its events; none for a window without events (0/0).
  std::optional<double> score() const;
  /// How many of its events were never seen in training.
  std::size_t unknown() const;
};

/// Cuts a stream of scored events into windows that do not overlap: window k holds
/// k * length <= t < (k + 1) * length. Windows without events are handed on like any other.
class Windows {
 public:
  using Handler = std::function<void(const Window&)>;

  /// @param length [ns], > 0
  /// @param handler called with every window when it is closed; must not call back
  /// @throw std::invalid_argument
  Windows(std::int64_t length, Handler handler);

  /// Closes the windows that end at or before the event, then counts it. An event that comes late,
  /// after its window was closed, counts in the open one.
  void add(const ScoredEvent& event);
  /// Closes all windows that end at or before `now` [ns]; silence has windows too.
  void advance(std::int64_t now);
  /// Closes the open window, if there is one: the recording ends.
  void finish();
  /// Forgets the open window; the grid starts again with the next event.
  void restart() { open_.reset(); }

  std::int64_t length() const { return length_; }

 private:
  std::int64_t length_;
  Handler handler_;
  std::optional<Window> open_;
};

}  // namespace self_awareness::core
