#include "core/evidence/lanes.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace self_awareness::core::evidence {

Lanes::Lanes(std::shared_ptr<const Model> model, std::vector<std::int64_t> starts)
    : model_(std::move(model)), starts_(std::move(starts)) {
  if (!std::is_sorted(starts_.begin(), starts_.end())) {
    throw std::invalid_argument("the starts of the stretches are not in order");
  }
  columns_.resize(starts_.size());
  for (Column& column : columns_) {
    column.shares.resize(model_->components().size());
  }
}

void Lanes::add(const Window& window, const Shares& shares) {
  const auto next = std::upper_bound(starts_.begin(), starts_.end(), window.start);
  if (next == starts_.begin()) {
    return;
  }
  Column& column = columns_[static_cast<std::size_t>(next - starts_.begin()) - 1];
  const auto raise = [&](EventId id, float share) {
    float& largest = column.shares[model_->componentIndex(id)];
    largest = std::max(largest, share);
  };
  for (std::size_t track = 0; track < shares.tracks.size(); ++track) {
    const auto share = static_cast<float>(shares.tracks[track]);
    if (share <= 0) {
      continue;
    }
    raise(model_->tracks()[track].to, share);
    if (share > column.strongest_share) {
      column.strongest_share = share;
      column.track = track;
    }
  }
  for (const auto& [id, share] : shares.never_heard) {
    raise(id, static_cast<float>(share));
  }
}

}  // namespace self_awareness::core::evidence
