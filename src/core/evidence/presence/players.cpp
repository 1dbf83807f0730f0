#include "core/evidence/presence/players.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace self_awareness::core::evidence {

Players::Players(const Model& model, std::shared_ptr<const Vocabulary> heard)
    : heard_(std::move(heard)) {
  for (const EventType& type : model.vocabulary().types()) {
    topics_.insert(type.scope);
  }
}

void Players::set(const std::set<EventType>& played) {
  std::map<std::string, Suspect> players;
  for (const EventType& type : played) {
    const std::optional<EventId> id = heard_ ? heard_->find(type) : std::nullopt;
    if (id && topics_.count(type.scope) > 0) {
      Suspect& suspect = players.try_emplace(type.source).first->second;
      suspect.id = *id;
      suspect.component = type.source;
      suspect.abnormal = true;
      suspect.reason.topics.push_back(type.scope);
    }
  }
  suspects_.clear();
  for (auto& [player, suspect] : players) {
    suspect.reason = playsOn(player, suspect.reason.topics);
    suspects_.push_back(std::move(suspect));
  }
}

void Players::closeWindow(Accepted& accepted) {
  any_ = std::any_of(suspects_.begin(), suspects_.end(), [&](const Suspect& suspect) {
    return !accepted.isAcceptedStranger(suspect.id);
  });
}

}  // namespace self_awareness::core::evidence
