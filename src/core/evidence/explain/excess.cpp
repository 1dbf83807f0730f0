#include "core/evidence/explain/excess.h"

#include <optional>
#include <utility>

namespace self_awareness::core::evidence {

Excesses::Excesses(std::shared_ptr<const Model> model) : model_(std::move(model)) {}

std::vector<Excess>& Excesses::closeWindow(const std::vector<double>& shares,
                                           const Scorer& scorer) {
  std::vector<Excess> now;
  auto before = excesses_.begin();
  for (std::size_t track = 0; track < shares.size(); ++track) {
    if (shares[track] < model_->tuning().least_share) {
      continue;
    }
    while (before != excesses_.end() && before->track < track) {
      ++before;
    }
    // A level does not know since when it has been so: since it was seen.
    std::optional<std::int64_t> onset = scorer.onset(track);
    if (!onset) {
      onset = before != excesses_.end() && before->track == track ? before->onset
                                                                  : scorer.heard().windowEnd();
    }
    now.push_back({track, model_->componentIndex(model_->tracks()[track].to), *onset,
                   shares[track], Excuse::kNone});
  }
  excesses_ = std::move(now);
  return excesses_;
}

}  // namespace self_awareness::core::evidence
