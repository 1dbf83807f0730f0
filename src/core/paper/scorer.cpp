#include "core/paper/scorer.h"

#include <algorithm>
#include <utility>

#include "core/paper/delay_table.h"

namespace self_awareness::core::paper {

Scorer::Scorer(std::shared_ptr<const Model> model)
    : model_(std::move(model)), bins_(model_->binning()) {
  restart();
}

void Scorer::restart() {
  seen_.clear();
  seen_.resize(model_->size());
  last_seen_.assign(model_->size(), std::nullopt);
  entropy_sums_.assign(model_->size(), 0);
}

Scorer::Scored Scorer::score(const Event& event) {
  Scored scored;
  scored.event.event = event;
  if (!model_->knows(event.id)) {
    scored.event.unknown = true;
    return scored;
  }
  const std::uint64_t mark = bins_.mark(event.stamp);
  const DelayTable::Sums sums = model_->table(event.id).sums(seen_, mark, bins_);
  // Eq. 3 with the weights 1 - h_ij / H_j of eq. 4 multiplied out; rounding must not make a 0
  // negative.
  const double entropy_sum = entropy_sums_[event.id];
  scored.score = entropy_sum > 0
                     ? std::max(sums.probabilities - sums.with_entropies / entropy_sum, 0.0)
                     : sums.probabilities;

  std::optional<std::int64_t>& last = last_seen_[event.id];
  if (last) {
    scored.event.gap = event.stamp - *last;
  } else {
    for (EventId to = 0; to < entropy_sums_.size(); ++to) {
      entropy_sums_[to] += model_->table(to).entropy(event.id);
    }
  }
  last = event.stamp;
  seen_.add(event.id, mark);
  return scored;
}

}  // namespace self_awareness::core::paper
