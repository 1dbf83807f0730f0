#include "self_awareness/core/paper/judge.h"

#include <cmath>
#include <stdexcept>

namespace self_awareness::core::paper {

Judge::Judge(const std::shared_ptr<const Model>& model, std::optional<double> threshold,
             bool silence_is_abnormal)
    : threshold_(threshold),
      silence_is_abnormal_(silence_is_abnormal),
      scorer_(model),
      blame_(model) {
  if (threshold_ && !std::isfinite(*threshold_)) {
    throw std::invalid_argument("the threshold must be a finite number");
  }
}

Judgement Judge::judge(const Window& window, std::int64_t /*end*/) {
  Judgement judgement;
  judgement.score = window.score();
  judgement.threshold = threshold_;
  if (threshold_) {
    judgement.abnormal =
        judgement.score ? *judgement.score < *threshold_ : silence_is_abnormal_ && 0 < *threshold_;
  }
  if (judgement.abnormal) {
    judgement.evidence = judgement.score ? "score" : "silence";
  }
  return judgement;
}

std::vector<Suspect> Judge::suspects(const Window& window, std::int64_t end) const {
  return blame_.suspects(window, scorer_.lastSeen(), end);
}

}  // namespace self_awareness::core::paper
