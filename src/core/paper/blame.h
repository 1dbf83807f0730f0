#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "self_awareness/core/paper/model.h"
#include "self_awareness/core/stream/windows.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::paper {

/// Ranks the event types that may have made a window abnormal (docs/method.md, section 2.5): first
/// the silent ones, the least probable silence first, then unknown ones, then those whose score is
/// far below what training lets expect.
class Blame {
 public:
  explicit Blame(std::shared_ptr<const Model> model);

  /// @param scores s_j of eq. 3 of the window's events
  /// @param last_seen when each event type was last seen [ns], at the window's end
  /// @param end of the window [ns]
  /// @return at most kMostSuspects, the most likely first
  std::vector<Suspect> suspects(const Window& window, const std::vector<double>& scores,
                                const std::vector<std::optional<std::int64_t>>& last_seen,
                                std::int64_t end) const;

 private:
  struct Usual {
    std::uint64_t gaps = 0;
    double shortest = 0;  // [s]
    double longest = 0;   // [s]
    double score = 0;     // expected s_j
  };

  Suspect suspectOf(EventId id) const;
  /// @param lasts whether it has not ended
  Reason silence(EventId id, double seconds, bool lasts) const;

  std::shared_ptr<const Model> model_;
  std::vector<Usual> usual_;  // by id
};

}  // namespace self_awareness::core::paper
