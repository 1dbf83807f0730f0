#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/evidence/channel/channel.h"
#include "self_awareness/core/evidence/channel/model.h"

namespace self_awareness::core::evidence {

/// Collects the evidence of every track from the events of one recording (docs/method.md, section
/// 3): it holds what was heard, and the state of every channel.
class Scorer {
 public:
  /// @param window length [ns] of the windows that rates are counted in
  Scorer(std::shared_ptr<const Model> model, std::int64_t window);

  /// Computes no evidence of such a finding: it stays 0.
  void leaveOut(Finding finding);
  /// Lets the channels know their limits.
  void capAt(const Limits& limits);

  /// @param event ignored if the model does not know its id
  /// @return delay since the last event of the same type [ns], if there was one
  std::optional<std::int64_t> add(const Event& event) {
    if (event.id >= gone_after_.size()) {
      return std::nullopt;
    }
    const Heard::Arrival arrival = heard_.begin(event);
    stalled_ = arrival.stalled;
    noteStandstill(event.stamp);
    for (ChannelState* const channel : listening_) {
      channel->add(arrival, heard_);
    }
    std::optional<std::int64_t> gap;
    if (arrival.last > 0) {
      gap = event.stamp - arrival.last_stamp;
      if (*gap > gone_after_[event.id]) {
        disarm(event.id);
      }
    }
    heard_.end(arrival);
    return gap;
  }
  /// Takes in that a mode of the robot is told (stream/mode.h), whether the model knows it or not.
  void enter(const Event& event) {
    heard_.enter(event);
    noteStandstill(event.stamp);
  }
  /// Takes in that the mode is not known any more, since the last window.
  void loseMode() { heard_.loseMode(); }
  /// Takes in which mode lasts when the recording begins.
  void enterBefore(std::optional<EventId> mode) { heard_.enterBefore(mode); }
  /// Takes in how the machine was.
  void hear(const Waiting& waiting) {
    heard_.hear(waiting);
    if (waiting.stoodStill()) {
      disarmAll();
    }
  }
  /// Closes a window.
  /// @param end of the window [ns]
  /// @return evidence by track; 0: none. What the caller changes lasts until the next window.
  std::vector<double>& closeWindow(std::int64_t end);
  /// Forgets what the sums say of an event type: what was unusual so far was its start.
  void forget(EventId id);
  /// The same, of what the channels of attributes say.
  void forgetAttributes(EventId id);
  /// Forgets what was seen, but for the mode: a new recording starts, or the clock was set.
  void restart();

  const Heard& heard() const { return heard_; }
  /// Whether the event that was added last may have waited while the whole robot stood still, or
  /// the machine had no time.
  bool stalled() const { return stalled_; }
  /// As ChannelState::raisedBy().
  double raisedBy(std::size_t track) const { return stateOf(track).raisedBy(track); }
  /// Whether a track that is beyond its limit is so beyond all doubt.
  bool isCertain(std::size_t track, double limit) const;
  /// Since when what a track sees has been so [ns]: a silence since the last event, a sum since it
  /// was 0 last. None: a level, which looks back for some time.
  std::optional<std::int64_t> onset(std::size_t track) const;
  /// Why an event type is a suspect, as a track says it.
  void explain(std::size_t track, const RecentEvents& events, Suspect& suspect) const;

 private:
  void disarm(EventId id);
  void disarmAll();
  void noteStandstill(std::int64_t stamp) {
    if (heard_.stoodStillUntil(stamp)) {
      disarmAll();
    }
  }
  const ChannelState& stateOf(std::size_t track) const { return *states_[state_of_[track]]; }

  std::shared_ptr<const Model> model_;
  Heard heard_;
  std::vector<std::unique_ptr<ChannelState>> states_;
  std::vector<ChannelState*> listening_;  // those of them that need events
  std::vector<ChannelState*> closing_;    // those of them that are not left out
  std::vector<std::size_t> state_of_;     // index of its state, by track
  std::vector<std::int64_t> gone_after_;  // a longer gap [ns] is that of a restart, by id
  std::vector<double> evidence_;          // by track
  bool stalled_ = false;
};

}  // namespace self_awareness::core::evidence
