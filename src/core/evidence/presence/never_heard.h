#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/evidence/watch/upstream.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::evidence {

/// Notices event types that do not come after the start, although they came in every recording of
/// the training (docs/method.md, section 3.8). A type that comes late as it always does is normal.
class NeverHeard {
 public:
  NeverHeard(const Model& model, const Limits& limits, std::shared_ptr<const Upstream> upstream);

  /// Takes in the next event, of any id. The first one is the start.
  void add(const Event& event);
  /// Excuses event types that need not come, and nobody else.
  /// @param may_be_silent by id of the model
  void excuse(std::vector<bool> may_be_silent) { may_be_silent_ = std::move(may_be_silent); }
  /// Whether event types come after every start, by id of the model.
  std::vector<bool> expected() const;
  /// Leaves out that this program stood still for so long [ns].
  void leaveOut(std::int64_t pause) { paused_ += pause; }
  /// Forgets what was heard: the next event is the start.
  void restart();
  /// Looks at what is missing at the end of a window.
  /// @param end of the window [ns]
  /// @param settle_time least time after the start in which everything may be missing [ns]
  void closeWindow(std::int64_t end, std::int64_t settle_time);
  /// The largest share of its limit that the absence of an event type has reached; 0 if nothing
  /// should have come by now. Above 1, it is abnormal: not if its component says other things, as
  /// then a topic is missing and no node, and not for ever.
  double share() const { return share_; }
  /// Those of the event types that should have come by now.
  std::vector<std::pair<EventId, double>> shares() const;
  /// The event types that should have come by now, sources upstream of others first.
  std::vector<Suspect> suspects() const;
  /// Whether the messages of one that should have come by now would reach the component of another
  /// event type; of one that training never saw, that is not known.
  bool isMissedBy(EventId id) const;

 private:
  /// An event type that comes after every start.
  struct Expected {
    EventId id = 0;
    std::int64_t shortest = 0;  // usual time from the start to its first event [ns]
    std::int64_t longest = 0;   // [ns]
    std::int64_t late = 0;      // so long after the start it comes late [ns]
    std::int64_t silent = 0;    // a silence of it is normal for so long [ns]
    double share = 0;           // of its limit that its absence has reached, once it is due

    /// When its start has had its time [ns].
    std::int64_t started(std::int64_t settle_time) const {
      return std::max(longest + settle_time, late);
    }
    /// When it is due after the start [ns].
    std::int64_t due(std::int64_t settle_time) const {
      return std::max(started(settle_time), silent);
    }
  };

  /// Those that are due and have to come.
  std::vector<Expected> missing() const;
  const std::string& component(EventId id) const;
  Reason reasonOf(const Expected& expected) const;
  std::vector<Expected> rootFirst(std::vector<Expected> missing) const;

  Vocabulary vocabulary_;
  double margin_of_waiting_;  // the time for its start: then it is an alarm
  std::int64_t alarm_later_;  // and at least so much later than due [ns]
  double accept_after_;       // so long after that, it is accepted [ns]
  std::shared_ptr<const Upstream> upstream_;
  std::vector<Expected> all_;
  std::vector<std::size_t> component_of_;  // index, by id
  std::vector<bool> heard_;                // by component
  std::vector<Expected> waiting_;          // of all, those that have not come and are not due
  std::vector<Expected> missing_;          // those that are due, sources upstream of others first
  std::vector<bool> may_be_silent_;        // by id
  std::optional<std::int64_t> start_;
  std::int64_t paused_ = 0;  // since then [ns]
  std::int64_t end_ = 0;     // of the last window [ns]
  double share_ = 0;
};

}  // namespace self_awareness::core::evidence
