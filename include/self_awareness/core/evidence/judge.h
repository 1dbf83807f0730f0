#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "self_awareness/core/evidence/blame.h"
#include "self_awareness/core/evidence/scorer.h"
#include "self_awareness/core/verdict/judge.h"

namespace self_awareness::core::evidence {

/// The evidence detector (METHOD.md, section 3): the largest evidence in units of its limit
/// decides over a window, and the linker, apart, over the last tens of seconds. The score is that
/// evidence, negative, and the threshold -1, so that as in eq. 5 low is abnormal.
class Judge : public core::Judge {
 public:
  /// @param limits none: not calibrated, windows have no score and are never abnormal
  /// @param graph who is upstream of whom; shared, so that it can be replaced meanwhile
  /// @throw std::invalid_argument if the limits are not those of the model
  Judge(std::shared_ptr<const Model> model, std::optional<Limits> limits, std::int64_t window,
        std::shared_ptr<const SourceGraph> graph);

  ScoredEvent add(const Event& event) override;
  Judgement judge(const Window& window, std::int64_t end) override;
  std::vector<Suspect> suspects(const Window& window, std::int64_t end) const override;
  void restart() override { scorer_.restart(); }

  static constexpr double kThreshold = -1;

 private:
  bool isSilent(std::int64_t end) const;

  std::shared_ptr<const Model> model_;
  std::optional<Limits> limits_;
  Scorer scorer_;
  Blame blame_;
  std::vector<double> shares_;  // of its limit that each track has reached
};

}  // namespace self_awareness::core::evidence
