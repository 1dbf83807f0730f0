#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "core/evidence/explain/excess.h"
#include "core/evidence/explain/explanation.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::evidence {

/// The excuse that a simulation runs slower than in training: who keeps the time of the real world
/// sends more often by its clock, and several that have nothing to do with each other do so by the
/// same factor, while others go on as usual (docs/method.md, section 6). Only in simulated time.
class SlowerClock {
 public:
  /// @param explanation says who follows whom
  SlowerClock(std::shared_ptr<const Model> model, const Explanation& explanation);

  /// Takes in a window, and excuses what is unusual of who sends faster by the common factor.
  /// @param excesses all that is unusual
  /// @param scorer that has closed the window
  /// @param events of the scorer's recording
  void excuse(std::vector<Excess>& excesses, const Scorer& scorer, const RecentEvents& events);
  /// Forgets that it was slower.
  void restart() {
    suspects_.clear();
    last_.reset();
    number_ = 0;
  }
  /// One for each component that sends faster; empty: the clock is as usual.
  const std::vector<Suspect>& suspects() const { return suspects_; }

 private:
  using ByComponent = std::map<std::size_t, Suspect>;

  /// Who sends faster, and by how much.
  ByComponent faster(const std::vector<Excess>& excesses, const Scorer& scorer,
                     const RecentEvents& events) const;
  /// Whether it is abnormal, none of them is why the others do so, and some are heard that do not.
  bool haveNoOtherReason(const ByComponent& faster, const std::vector<Excess>& excesses,
                         const Heard& heard) const;

  std::shared_ptr<const Model> model_;
  const Explanation& explanation_;
  std::vector<Suspect> suspects_;     // of the last window
  std::optional<std::int64_t> last_;  // time that two were faster [ns]
  std::size_t number_ = 0;            // of those that were
  Reason reason_;
};

}  // namespace self_awareness::core::evidence
