#include "self_awareness/core/scorer.h"

#include <utility>

namespace self_awareness::core {

Scorer::Scorer(std::shared_ptr<const Model> model) : model_(std::move(model)) {
  restart();
}

void Scorer::restart() {
  last_seen_.assign(model_->size(), std::nullopt);
  entropy_sums_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(model_->size()));
}

ScoredEvent Scorer::score(const Event& event) {
  ScoredEvent scored;
  scored.event = event;
  if (!model_->knows(event.id)) {
    scored.unknown = true;
    return scored;
  }
  const Eigen::MatrixXd& entropies = model_->entropies();
  const double entropy_sum = entropy_sums_(event.id);
  for (EventId from = 0; from < last_seen_.size(); ++from) {
    if (!last_seen_[from]) {
      continue;
    }
    const double probability =
        model_->probability(from, event.id, event.stamp - *last_seen_[from]);
    const double weight = entropy_sum > 0 ? 1 - entropies(from, event.id) / entropy_sum : 1;
    scored.score += weight * probability;
  }

  std::optional<std::int64_t>& last = last_seen_[event.id];
  if (last) {
    scored.gap = event.stamp - *last;
  } else {
    entropy_sums_ += entropies.row(event.id).transpose();
  }
  last = event.stamp;
  return scored;
}

}  // namespace self_awareness::core
