#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/evidence/watch/stalls.h"
#include "core/evidence/watch/starvation.h"
#include "self_awareness/core/evidence/count/statistics.h"
#include "self_awareness/core/evidence/tuning.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/stream/mode.h"

namespace self_awareness::core::evidence {

/// What has one cause shows within so long: what was there longer before is not why [ns].
constexpr std::int64_t kOneCause = 5 * kRateSpan;

/// What was heard of a recording so far, as all channels need it: who came when last, and
/// whether the whole robot stood still (docs/method.md, sections 1.4 and 3.7).
class Heard {
 public:
  /// @param types number of event types
  /// @param window length [ns]
  /// @param stalls of the robot's machine, and what are none
  Heard(std::size_t types, std::int64_t window, Stalls stalls, const Tuning& tuning);

  /// The event that is taken in: what it is to those before.
  struct Arrival {
    std::int64_t stamp = 0;  ///< [ns]
    EventId id = 0;
    std::uint64_t last = 0;       ///< number of the event of its type before it; 0: there was none
    std::int64_t last_stamp = 0;  ///< of that one [ns]; its own if there was none
    bool stalled = false;         ///< it may have waited while the whole robot stood still, or
                                  ///< the machine had no time
    Attributes attributes{};
  };
  /// The mode is not known any more, since the last window.
  void loseMode() { mode_.enter(std::nullopt, window_end_); }
  /// The mode of the robot that lasts when the recording begins.
  void enterBefore(std::optional<EventId> mode) {
    mode_.enter(mode, 0);
    mode_.restart();
  }
  /// Takes in how the machine was in the stretch of time after the one before.
  void hear(const Waiting& waiting);
  /// Begins to take in an event; the channels see it before end() does.
  Arrival begin(const Event& event) {
    note(event.stamp);
    const std::uint64_t last = numbers_[event.id];
    return {event.stamp,
            event.id,
            last,
            last > 0 ? stamps_[event.id] : event.stamp,
            stalls_.holdsBack(event.stamp) || starvation_.holdsBack(event.stamp),
            event.attributes};
  }
  void end(const Arrival& arrival) {
    stamps_[arrival.id] = arrival.stamp;
    paused_before_[arrival.id] = arrival.stamp < pause_.to ? pause_.before : pause_.all;
    numbers_[arrival.id] = ++number_;
  }
  /// A mode of the robot is told (stream/mode.h), whether the model knows it or not.
  void enter(const Event& mode) {
    note(mode.stamp);
    ++number_;
    mode_.enter(mode.id, mode.stamp);
  }
  void closeWindow(std::int64_t end);
  /// Forgets what was heard, but for the mode: a new recording starts, or the clock was set.
  void restart();

  /// Stamps of the last events [ns], by id.
  const std::int64_t* stamps() const { return stamps_.data(); }
  /// Numbers of the last events in the recording, from 1, by id; 0: there was none.
  const std::uint64_t* numbers() const { return numbers_.data(); }
  /// @param id of the model
  bool hasSeen(EventId id) const { return numbers_[id] > 0; }
  /// Stamp of the last event of a type [ns]; none before the first.
  std::optional<std::int64_t> lastSeen(EventId id) const {
    return hasSeen(id) ? std::optional<std::int64_t>(stamps_[id]) : std::nullopt;
  }
  /// Stamp of the first event of the recording [ns].
  std::int64_t start() const { return start_; }
  /// End of the window that was closed last [ns].
  std::int64_t windowEnd() const { return window_end_; }
  /// The mode that the robot is in; none: it is not known.
  const std::optional<EventId>& mode() const { return mode_.mode(); }
  /// The same, and for how long up to now [ns].
  std::optional<LastingMode> lasting(std::int64_t now) const { return mode_.lasting(now); }
  /// How long a mode has lasted since the start, up to a stamp [ns].
  std::int64_t lasted(EventId mode, std::int64_t stamp) const { return mode_.lasted(mode, stamp); }
  /// Time since the last event of a type, at the end of the last window [ns]; 0 before the first.
  std::int64_t silence(EventId id) const { return hasSeen(id) ? window_end_ - stamps_[id] : 0; }
  /// The same without the time in which this program stood still, and heard nobody: the longer
  /// part of before and after it. Who stood still with it may have another phase since.
  std::int64_t listenedFor(EventId id) const {
    const std::int64_t paused = pause_.all - paused_before_[id];
    const std::int64_t all = std::max<std::int64_t>(silence(id) - paused, 0);
    const std::int64_t after = std::clamp<std::int64_t>(window_end_ - pause_.to, 0, all);
    return paused > 0 ? std::max(after, all - after) : all;
  }
  /// The same without the time in which the whole robot stood still, or its machine was starved:
  /// then nobody's silence grows.
  std::int64_t age(EventId id) const {
    return hasSeen(id) ? std::max<std::int64_t>(listenedFor(id) - stoodStillSince(stamps_[id]), 0)
                       : 0;
  }
  /// How long the whole robot stood still, or its machine was starved, since a stamp [ns], at the
  /// end of the last window.
  std::int64_t stoodStillSince(std::int64_t stamp) const {
    return std::max(stalls_.standstillSince(stamp, window_end_), starvedSince(stamp));
  }
  /// Whether the whole robot stood still until a stamp [ns].
  bool stoodStillUntil(std::int64_t stamp) const { return stalls_.endedAt(stamp); }
  /// How long processes waited since a stamp [ns], at the end of the last window; at most for as
  /// long as a stall lasts [ns].
  std::int64_t starvedSince(std::int64_t stamp) const {
    return std::min(starvation_.waitedIn(stamp, window_end_), longest_stall_);
  }
  /// How long processes waited in the last kRateSpan while the machine was starved, at the end of
  /// the last window [ns].
  std::int64_t starved() const { return starvation_.waitedIn(0, window_end_); }
  /// Length of a window [ns].
  std::int64_t window() const { return window_; }

 private:
  /// How long this program stood still.
  struct Pause {
    std::int64_t to = 0;      // end of the last time [ns]
    std::int64_t before = 0;  // all before that [ns]
    std::int64_t all = 0;     // [ns]
  };

  void note(std::int64_t stamp) {
    if (number_ == 0) {
      start_ = stamp;
      mode_.begin(stamp);
    }
    stalls_.add(stamp, number_ > 0);
  }

  std::int64_t window_;  // [ns]
  Stalls stalls_;
  Starvation starvation_;
  ModeTime mode_;
  std::int64_t longest_stall_;               // that is forgiven [ns]
  std::int64_t start_ = 0;                   // [ns], once there was an event
  std::vector<std::int64_t> stamps_;         // of the last event [ns], by id
  std::vector<std::uint64_t> numbers_;       // of the last event in the recording, by id; 0: none
  std::vector<std::int64_t> paused_before_;  // of the pauses, those before the last event, by id
  Pause pause_;
  std::uint64_t number_ = 0;
  std::int64_t window_end_ = 0;  // [ns]
};

}  // namespace self_awareness::core::evidence
