#pragma once

#include <cstdint>

#include "self_awareness/core/evidence/count/statistics.h"
#include "self_awareness/core/evidence/tuning.h"

namespace self_awareness::core::evidence {

/// Notices that the whole robot stops for a moment and goes on: its machine was busy, and no
/// component is to blame (docs/method.md, section 3.7).
class Stalls {
 public:
  /// @param longest_silence the longest time without any event in training that was no stall [ns]
  /// @param longest_stall of the machine in training [ns]; 0: there was none
  Stalls(std::int64_t longest_silence, std::int64_t longest_stall, const Tuning& tuning);

  /// Takes in an event.
  /// @param stamp [ns]
  /// @param heard whether there was one before it
  void add(std::int64_t stamp, bool heard) {
    const std::int64_t silence = stamp - last_stamp_;
    if (heard && silence > usual_ && silence <= longest_ && (at_ == 0 || stamp - at_ > between_)) {
      from_ = last_stamp_;
      at_ = stamp;
      until_ = stamp + silence;
    }
    last_stamp_ = stamp > last_stamp_ ? stamp : last_stamp_;
  }
  /// This program stood still up to a stamp [ns]: that it heard nothing says nothing of the robot.
  void passTo(std::int64_t stamp) { last_stamp_ = stamp > last_stamp_ ? stamp : last_stamp_; }
  /// Whether an event of now [ns] may have waited for the end of a stall.
  bool holdsBack(std::int64_t stamp) const { return stamp < until_; }
  /// Whether a stall ended with an event of now [ns].
  bool endedAt(std::int64_t stamp) const { return at_ == stamp; }
  /// @param end of the window [ns]
  /// @param heard whether there was an event
  void closeWindow(std::int64_t end, bool heard);
  /// How long the robot stood still since a stamp [ns], at the end of a window.
  std::int64_t standstillSince(std::int64_t stamp, std::int64_t end) const {
    const bool over = now_ > 0 || end >= until_ + kRateSpan || stamp > from_;
    return over ? now_ : at_ - from_;
  }
  void restart();

 private:
  std::int64_t usual_;           // longest silence that is no stall [ns]
  std::int64_t longest_;         // longest stall [ns]
  std::int64_t between_;         // in which one stall is forgiven [ns]
  std::int64_t last_stamp_ = 0;  // [ns], once there was an event
  std::int64_t now_ = 0;         // the stall that goes on at the end of the last window [ns]
  std::int64_t from_ = 0;        // begin of the last stall [ns]
  std::int64_t at_ = 0;          // end of the last stall [ns]; 0: none
  std::int64_t until_ = 0;       // what waited has come by then [ns]
};

}  // namespace self_awareness::core::evidence
