#include "core/evidence/blame/followers.h"

#include <algorithm>

namespace self_awareness::core::evidence {

Suspect suspectOf(std::size_t track, const Scorer& scorer, const RecentEvents& events) {
  Suspect suspect;
  suspect.id = scorer.model().tracks().at(track).to;
  scorer.explain(track, events, suspect);
  return suspect;
}

Followers::Followers(std::shared_ptr<const Model> model) : model_(std::move(model)) {
  for (const Track& track : model_->tracks()) {
    follows_.push_back(follows(track));
  }
}

bool Followers::follows(const Track& track) const {
  if (model_->component(track.from) == model_->component(track.to) ||
      model_->vocabulary().tellsMode(track.from)) {
    return false;
  }
  const double period = std::min(model_->meanGap(track.from), model_->meanGap(track.to));
  return model_->usualDelay(track.from, track.to, 0.5) < period / 2;
}

Followers::Leads Followers::leads(const std::vector<double>& shares) const {
  Leads usual;
  Leads unusual;
  for (std::size_t track = 0; track < shares.size(); ++track) {
    if (follows_[track]) {
      (shares[track] < model_->tuning().least_share ? usual : unusual)
          .emplace(model_->componentIndex(model_->tracks()[track].from),
                   model_->componentIndex(model_->tracks()[track].to));
    }
  }
  Leads leads;
  for (const auto& [leader, follower] : usual) {
    if (unusual.count({leader, follower}) == 0 && usual.count({follower, leader}) == 0) {
      leads.emplace(leader, follower);
    }
  }
  return leads;
}

std::vector<std::size_t> Followers::lateBefore(const std::vector<std::size_t>& late,
                                               const std::vector<double>& shares,
                                               const Scorer& scorer,
                                               const RecentEvents& events) const {
  const std::vector<Track>& tracks = model_->tracks();
  std::vector<std::size_t> found;
  const auto addOf = [&](EventId third, EventId from) {
    for (std::size_t track = 0; track < tracks.size(); ++track) {
      if (model_->finding(track) == Finding::kBetween && tracks[track].to == third &&
          tracks[track].from == from && follows_[track]) {
        const Suspect suspect = suspectOf(track, scorer, events);
        if (suspect.reason.times > 0 && suspect.reason.kind != Kind::kEarly) {
          found.push_back(track);
        }
      }
    }
  };
  for (const std::size_t victim : late) {
    for (std::size_t track = 0; track < tracks.size(); ++track) {
      if (model_->finding(track) == Finding::kBetween && tracks[track].to == tracks[victim].to &&
          follows_[track] && shares[track] < model_->tuning().least_share) {
        addOf(tracks[track].from, tracks[victim].from);
      }
    }
  }
  return found;
}

}  // namespace self_awareness::core::evidence
