#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "self_awareness/core/evidence/count/statistics.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/stream/mode.h"
#include "self_awareness/core/stream/recent_counts.h"

namespace self_awareness::core::evidence {

/// A time in which the whole robot stood still, since its machine was busy.
struct MachineStall {
  std::size_t event = 0;    ///< number of the first event after it in the recording, from 0
  std::int64_t end = 0;     ///< stamp of that one [ns]
  std::int64_t length = 0;  ///< [ns]
};

/// Counts one recording after the other into a Statistics, in one pass (docs/method.md, section
/// 3.1); the last delays are there when the recording has ended. No delay and no window crosses
/// from one recording into the next, or a step of the clock (stream/clock.h). A mode of the robot
/// counts as an event type whose events are its ticks (stream/mode.h): for all but delays and
/// gaps, there are none.
class Trainer {
 public:
  /// @param statistics counted into; must outlive the trainer
  /// @param window length [ns] of the windows in which rates are counted, > 0
  /// @throw std::invalid_argument
  Trainer(Statistics& statistics, std::int64_t window);
  ~Trainer();
  Trainer(const Trainer&) = delete;
  Trainer& operator=(const Trainer&) = delete;

  /// What is known of a recording before its events.
  struct Start {
    std::optional<std::int64_t> since;  ///< when it began [ns], if not all of it is counted
    std::int64_t robot_start = 0;       ///< when the robot was started [ns]; 0: not known
    std::string robot{};                ///< its name; empty: not known
    /// When its machine stood still, in their order: that time is taken out of delays and gaps.
    std::vector<MachineStall> stalls{};
  };
  /// Ends the recording: the next event belongs to a new one.
  void startRecording() { startRecording(Start{}); }
  void startRecording(Start start);
  /// Starts a new recording of the same start of the robot: the clock was set.
  void onClockStep();
  /// An event of the recording before those that are counted: it only says when its type came
  /// first, or which mode lasts then.
  void addBefore(const Event& event);
  /// @param event with an id of the statistics' vocabulary; in the order of the recording.
  void add(const Event& event);
  /// Counts what comes next into other statistics, which must have the same event types and
  /// outlive the trainer. The recording goes on; its end decides which ones name it.
  void countInto(Statistics& statistics) {
    countWaiting();
    statistics_ = &statistics;
  }
  /// Ends the last recording.
  void finish() { startRecording(); }

 private:
  struct Seen {
    std::int64_t stamp = 0;    // [ns]
    std::uint64_t number = 0;  // of the event in the recording, from 1; 0: never seen
  };

  /// Delays of events of one type that are counted together: of a thousand types, counts lie in no
  /// cache, and are fetched once for all of them.
  struct Waiting {
    std::vector<std::uint8_t> bins;
    std::vector<std::uint8_t> came;
  };

  struct OfMessages;  // what is remembered of the attributes of a type's messages

  void resizeRecording();
  void noteFirst(const Event& event);
  /// Makes room for the event types that are new.
  void resize();
  /// Counts an event, or a tick, but for rates and attributes.
  void count(const Event& event);
  void countTicks(std::int64_t now);
  void countDelays(const Event& event);
  void countWaiting();
  /// @param started whether its type came first long enough ago
  void countAttributes(const Event& event, bool started);
  void closeWindows(std::int64_t now);
  void endRecording();
  /// How long the machine stood still before the next event of the recording [ns].
  std::int64_t stallBeforeNext();

  Statistics* statistics_;
  std::int64_t window_;
  Statistics::Recording recording_;         // the open one
  std::optional<std::int64_t> since_;       // when it began [ns]; none: with its first event
  std::vector<Seen> last_seen_;             // by id
  std::vector<Waiting> waiting_;            // by id
  std::optional<std::int64_t> last_stamp_;  // [ns]
  std::int64_t newest_stamp_ = 0;           // [ns], once something was seen
  std::int64_t window_end_ = 0;             // of the open window [ns], once something was seen
  std::uint64_t number_ = 0;
  RecentCounts counts_;
  ModeTime mode_;
  std::vector<OfMessages> messages_;  // by id
  std::vector<MachineStall> stalls_;  // of the recording
  std::size_t next_stall_ = 0;
  std::size_t next_event_ = 0;    // of the recording
  std::int64_t stood_still_ = 0;  // since the recording's start or the last step of its clock [ns]
  // What waited in the last stall has come by then, without stalls [ns]; none: there was none.
  std::optional<std::int64_t> waited_until_;
};

}  // namespace self_awareness::core::evidence
