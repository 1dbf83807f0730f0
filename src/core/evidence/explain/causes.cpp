#include "core/evidence/explain/causes.h"

#include <algorithm>
#include <numeric>

namespace self_awareness::core::evidence {

Causes::Causes(std::shared_ptr<const Model> model, std::shared_ptr<const Upstream> upstream)
    : model_(std::move(model)), upstream_(std::move(upstream)) {
  for (const Track& track : model_->tracks()) {
    follows_.push_back(follows(track));
  }
}

bool Causes::follows(const Track& track) const {
  if (model_->component(track.from) == model_->component(track.to) ||
      model_->vocabulary().tellsMode(track.from)) {
    return false;
  }
  const double period = std::min(model_->meanGap(track.from), model_->meanGap(track.to));
  return model_->usualDelay(track.from, track.to, 0.5) < period / 2;
}

const Causes::Leads& Causes::leads() const {
  if (leads_) {
    return *leads_;
  }
  Leads usual;
  Leads unusual;
  auto excess = excesses_->begin();
  for (std::size_t track = 0; track < follows_.size(); ++track) {
    excess = std::find_if(excess, excesses_->end(),
                          [track](const Excess& each) { return each.track >= track; });
    if (follows_[track]) {
      const bool is_usual = excess == excesses_->end() || excess->track != track;
      const Track& relation = model_->tracks()[track];
      (is_usual ? usual : unusual)
          .emplace(model_->componentIndex(relation.from), model_->componentIndex(relation.to));
    }
  }
  leads_.emplace();
  for (const auto& [leader, follower] : usual) {
    if (unusual.count({leader, follower}) == 0 && usual.count({follower, leader}) == 0) {
      leads_->emplace(leader, follower);
    }
  }
  return *leads_;
}

std::vector<bool> Causes::downstreamOf(std::size_t component) const {
  std::vector<bool> downstream(model_->components().size(), false);
  for (std::size_t other = 0; other < downstream.size(); ++other) {
    downstream[other] = isUpstream(component, other);
  }
  for (bool grows = areGuessed(); grows;) {
    grows = false;
    for (const auto& [leader, follower] : leads()) {
      const bool is_new = (leader == component || downstream[leader]) && !downstream[follower];
      downstream[follower] = downstream[follower] || is_new;
      grows = grows || is_new;
    }
  }
  return downstream;
}

std::vector<std::size_t> rootFirst(std::size_t number,
                                   const std::function<bool(std::size_t, std::size_t)>& is_root) {
  std::vector<std::size_t> roots(number, 0);  // of those that are left
  std::vector<std::vector<std::size_t>> victims(number);
  for (std::size_t root = 0; root < number; ++root) {
    for (std::size_t victim = 0; victim < number; ++victim) {
      if (root != victim && is_root(root, victim)) {
        victims[root].push_back(victim);
        ++roots[victim];
      }
    }
  }
  std::vector<std::size_t> ordered;
  std::vector<std::size_t> left(number);
  std::iota(left.begin(), left.end(), 0);
  while (!left.empty()) {
    const auto next =
        std::min_element(left.begin(), left.end(),
                         [&](std::size_t a, std::size_t b) { return roots[a] < roots[b]; });
    ordered.push_back(*next);
    for (const std::size_t victim : victims[*next]) {
      --roots[victim];
    }
    left.erase(next);
  }
  return ordered;
}

}  // namespace self_awareness::core::evidence
