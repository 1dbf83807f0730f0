#include "core/evidence/explain/excess.h"

#include <algorithm>
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
    const std::int64_t end = scorer.heard().windowEnd();
    const bool lasts = before != excesses_.end() && before->track == track;
    const Track& watched = model_->tracks()[track];
    Excess excess;
    excess.track = track;
    excess.channel = watched.channel;
    excess.id = watched.to;
    excess.from = watched.from;
    excess.component = model_->componentIndex(watched.to);
    // A level does not know since when it has been so: since it was seen.
    excess.onset = scorer.onset(track).value_or(lasts ? before->onset : end);
    excess.share = shares[track];
    if (excess.share > 1) {
      excess.abnormal = lasts ? std::min(before->abnormal, end) : end;
    }
    now.push_back(excess);
  }
  excesses_ = std::move(now);
  return excesses_;
}

}  // namespace self_awareness::core::evidence
