#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "self_awareness/core/paper/model.h"
#include "self_awareness/core/paper/scorer.h"
#include "self_awareness/core/stream/windows.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::paper {

/// Ranks the event types that an abnormal window may be blamed on (METHOD.md, section 5): first
/// those with the smallest probability of so long a silence by their own gaps in training, then
/// unknown events, then those whose score is far below what training lets expect.
class Blame {
 public:
  explicit Blame(std::shared_ptr<const Model> model);

  /// @param last_seen when each event type was last seen [ns], at the window's end
  /// @param end of the window [ns]
  /// @return at most five suspects, the first the most likely
  std::vector<Suspect> suspects(const Window& window,
                                const std::vector<std::optional<std::int64_t>>& last_seen,
                                std::int64_t end) const;

  /// Natural logarithm of the probability of a gap of at least this age [ns] between two events
  /// of the type: the share of such gaps in training, beyond the longest one b with the tail
  /// exp(-age / b). 0 if the type is too rare to be judged.
  double logSurvival(EventId id, std::int64_t age) const;
  /// Whether training saw enough gaps to know what is usual.
  bool judged(EventId id) const { return usual_.at(id).gaps >= kFewestGaps; }

 private:
  struct Usual {
    std::uint64_t gaps = 0;
    double shortest = 0;  // [s]
    double longest = 0;   // [s]
    double maximum = 0;   // [s]
    double score = 0;     // expected s_j
  };

  std::shared_ptr<const Model> model_;
  std::vector<Usual> usual_;  // by id
};

}  // namespace self_awareness::core::paper
