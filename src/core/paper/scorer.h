#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/paper/delay_bins.h"
#include "self_awareness/core/paper/model.h"
#include "self_awareness/core/stream/windows.h"

namespace self_awareness::core::paper {

/// Scores events one after the other (docs/method.md, section 2.2): eq. 3 with the weights of eq.
/// 4, over the event types of training that were seen before in this recording. An event is scored
/// first, then tracked.
class Scorer {
 public:
  explicit Scorer(std::shared_ptr<const Model> model);

  /// What was seen of an event, and its score.
  struct Scored {
    ObservedEvent event;
    double score = 0;  ///< s_j of eq. 3, 0 or more; 0 if the event is unknown
  };

  /// @param event unknown if the model does not know its id: it scores 0 and is not tracked
  Scored score(const Event& event);
  /// Forgets what was seen: a new recording starts, or the clock was set.
  void restart();

  /// Stamp of the last event of each type of the model [ns], by id; none before the first.
  const std::vector<std::optional<std::int64_t>>& lastSeen() const { return last_seen_; }

 private:
  std::shared_ptr<const Model> model_;
  DelayBins bins_;
  SeenTypes seen_;
  std::vector<std::optional<std::int64_t>> last_seen_;  // [ns] by id
  std::vector<double> entropy_sums_;                    // H_j over the e_i that were seen, by j
};

}  // namespace self_awareness::core::paper
