#include "core/evidence/excuse/settling.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

#include "core/evidence/channel/channel.h"

namespace self_awareness::core::evidence {

void Settling::cover(EventId id, std::int64_t until) {
  if (model_->knows(id)) {
    std::int64_t& known = until_.try_emplace(id, until).first->second;
    known = std::max(known, until);
  }
}

void Settling::coverAll(std::int64_t until) {
  all_until_ = std::max(all_until_.value_or(until), until);
}

void Settling::forgetStarts(std::int64_t now, Scorer& scorer) {
  for (auto each = until_.begin(); each != until_.end();) {
    const bool has_settled = each->second <= now;
    if (has_settled) {
      scorer.forget(each->first);
    }
    each = has_settled ? until_.erase(each) : std::next(each);
  }
  if (all_until_ && *all_until_ <= now) {
    for (EventId id = 0; id < model_->size(); ++id) {
      scorer.forget(id);
    }
    all_until_.reset();
  }
}

void Settling::leaveOut(std::vector<double>& evidence) const {
  if (!all_until_ && until_.empty()) {
    return;
  }
  std::vector<bool> settles(model_->size(), false);
  for (const auto& [id, until] : until_) {
    settles[id] = true;
  }
  for (std::size_t track = 0; track < evidence.size(); ++track) {
    const Track& watched = model_->tracks()[track];
    if (settles[watched.to] || settles[watched.from] ||
        (all_until_ && watched.channel->finding() != Finding::kSilent)) {
      evidence[track] = 0;
    }
  }
}

}  // namespace self_awareness::core::evidence
