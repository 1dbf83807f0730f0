#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "self_awareness/core/paper/blame.h"
#include "self_awareness/core/paper/scorer.h"
#include "self_awareness/core/verdict/judge.h"

namespace self_awareness::core::paper {

/// The paper's detector: the score of eq. 2 to 4 against the threshold s* of eq. 5.
class Judge : public core::Judge {
 public:
  /// @param threshold s*; none: windows are scored and never abnormal
  /// @param silence_is_abnormal a window without events scores 0, else nothing
  /// @throw std::invalid_argument if the threshold is not finite
  Judge(const std::shared_ptr<const Model>& model, std::optional<double> threshold,
        bool silence_is_abnormal);

  ScoredEvent add(const Event& event) override { return scorer_.score(event); }
  Judgement judge(const Window& window, std::int64_t end) override;
  std::vector<Suspect> suspects(const Window& window, std::int64_t end) const override;
  void restart() override { scorer_.restart(); }

 private:
  std::optional<double> threshold_;
  bool silence_is_abnormal_;
  Scorer scorer_;
  Blame blame_;
};

}  // namespace self_awareness::core::paper
