#include "core/evidence/excuse/settling.h"

#include <algorithm>
#include <utility>

#include "core/evidence/channel/channel.h"

namespace self_awareness::core::evidence {

Settling::Settling(std::shared_ptr<const Model> model)
    : model_(std::move(model)), until_(model_->size(), kNever) {}

void Settling::cover(EventId id, std::int64_t until) {
  if (model_->knows(id)) {
    until_[id] = std::max(until_[id], until);
    latest_ = std::max(latest_, until_[id]);
    any_ = true;
  }
}

void Settling::coverAll(std::int64_t until) {
  all_until_ = std::max(all_until_, until);
  latest_ = std::max(latest_, until);
  any_ = true;
}

void Settling::forgetStarts(std::int64_t now, Scorer& scorer) {
  for (EventId id = 0; any_ && id < until_.size(); ++id) {
    const std::int64_t until = std::max(until_[id], all_until_);
    if (last_window_ < until && until <= now) {
      scorer.forget(id);
    }
  }
  any_ = now < latest_;
  last_window_ = now;
}

void Settling::leaveOut(std::int64_t now, std::vector<double>& evidence) const {
  if (now >= latest_) {
    return;
  }
  for (std::size_t track = 0; track < evidence.size(); ++track) {
    const Track& watched = model_->tracks()[track];
    if (now < std::max(until_[watched.to], until_[watched.from]) ||
        (now < all_until_ && watched.channel->finding() != Finding::kSilent)) {
      evidence[track] = 0;
    }
  }
}

void Settling::restart() {
  *this = Settling(model_);
}

}  // namespace self_awareness::core::evidence
