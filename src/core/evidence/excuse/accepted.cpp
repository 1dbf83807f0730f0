#include "core/evidence/excuse/accepted.h"

#include <algorithm>
#include <utility>

#include "core/evidence/channel/channel.h"

namespace self_awareness::core::evidence {

Accepted::Accepted(std::shared_ptr<const Model> model, std::shared_ptr<const Vocabulary> heard)
    : model_(std::move(model)),
      vocabulary_(std::move(heard)),
      is_optional_(model_->size(), false),
      may_be_silent_(model_->size(), false) {}

void Accepted::accept(const Acceptances& accepted) {
  accepted_ = accepted;
  is_accepted_.clear();
  for (EventId id = 0; id < model_->size(); ++id) {
    is_optional_[id] =
        accepted.mayBeAbsent(model_->component(id), model_->vocabulary().at(id).scope);
    may_be_silent_[id] = is_optional_[id] || isAccepted(id, Kind::kSilent);
  }
  tracks_.clear();
  optional_.clear();
  for (std::size_t track = 0; track < model_->tracks().size(); ++track) {
    const Track& watched = model_->tracks()[track];
    if (covers(watched) || (is_optional_[watched.to] && isAbsence(model_->finding(track)))) {
      tracks_.push_back(track);
    } else if (is_optional_[watched.to] || is_optional_[watched.from]) {
      optional_.push_back(track);
    }
  }
}

bool Accepted::isAcceptedStranger(EventId id) {
  const auto [known, is_new] = is_accepted_.try_emplace(id, false);
  if (is_new) {
    known->second = isAccepted(id, Kind::kStranger);
  }
  return known->second;
}

bool Accepted::isAbsent(EventId id, const Heard& heard) const {
  return is_optional_[id] && !model_->vocabulary().tellsMode(id) &&
         (!heard.hasSeen(id) || heard.silence(id) > model_->longestGap(id));
}

void Accepted::leaveOut(const Heard& heard, std::vector<double>& evidence) const {
  for (const std::size_t track : tracks_) {
    evidence[track] = 0;
  }
  for (const std::size_t track : optional_) {
    const Track& watched = model_->tracks()[track];
    if (isAbsent(watched.to, heard) || isAbsent(watched.from, heard)) {
      evidence[track] = 0;
    }
  }
}

void Accepted::leaveOut(std::vector<Suspect>& suspects) const {
  const auto isExcused = [this](const Suspect& suspect) {
    const Kind kind = suspect.reason.kind;
    // What is not subscribed to is no topic of an event type: Unsubscribed leaves it out.
    return kind != Kind::kUnsubscribed && this->isExcused(suspect.id, kind);
  };
  suspects.erase(std::remove_if(suspects.begin(), suspects.end(), isExcused), suspects.end());
}

bool Accepted::isExcused(EventId id, Kind kind) const {
  return isAccepted(id, kind) || (model_->knows(id) && is_optional_[id] && isAbsence(kind));
}

bool Accepted::isAccepted(EventId id, Kind kind) const {
  if (accepted_.list().empty() ||
      (!model_->knows(id) && (!vocabulary_ || id >= vocabulary_->size()))) {
    return false;
  }
  const EventType& type = model_->knows(id) ? model_->vocabulary().at(id) : vocabulary_->at(id);
  return accepted_.covers(componentOf(type.source, type.scope), type.scope, kind);
}

bool Accepted::covers(const Track& track) const {
  const Kind kind = track.channel->kind();
  return isAccepted(track.to, kind) ||
         (track.channel->finding() == Finding::kBetween && isAccepted(track.from, kind));
}

}  // namespace self_awareness::core::evidence
