#include "core/evidence/presence/two_senders.h"

#include <algorithm>
#include <string>
#include <utility>

namespace self_awareness::core::evidence {
namespace {

// Who is started again may overlap with who ends.
constexpr std::int64_t kRestart = 2 * kRateSpan;

/// Whether the messages of an event type came from one sender in training, as far as their numbers
/// say it.
bool cameFromOne(const AttributeCounts& counts, const Tuning& tuning) {
  const auto back =
      static_cast<double>(counts.steps[static_cast<std::size_t>(Attributes::Step::kRestart)]);
  // Where two count their messages, half of the numbers go back.
  return back <= (1 - tuning.usual) * static_cast<double>(counts.numbered());
}

}  // namespace

TwoSenders::TwoSenders(std::shared_ptr<const Model> model) : model_(std::move(model)) {
  for (EventId id = 0; id < model_->size(); ++id) {
    const EventType& type = model_->vocabulary().at(id);
    if (!type.source.empty() && !model_->vocabulary().tellsMode(id)) {
      ids_[{type.source, type.scope}].push_back(id);
    }
  }
}

void TwoSenders::set(const std::set<SourceGraph::Publication>& doubled) {
  doubled_.clear();
  std::set<std::string> sources;
  for (const SourceGraph::Publication& each : doubled) {
    const auto known = ids_.find(each);
    if (known != ids_.end() &&
        std::all_of(known->second.begin(), known->second.end(), [this](EventId id) {
          return cameFromOne(model_->learned().type(id).attributes, model_->tuning());
        })) {
      doubled_.insert(each);
      sources.insert(each.first);
    }
  }
  types_.clear();
  for (const auto& [publication, ids] : ids_) {
    if (sources.count(publication.first) > 0) {
      types_.insert(types_.end(), ids.begin(), ids.end());
    }
  }
  if (doubled_.empty()) {
    since_.reset();
    lasting_ = false;
  }
}

void TwoSenders::closeWindow(const Heard& heard) {
  if (any()) {
    since_ = since_.value_or(heard.windowEnd());
    lasting_ = heard.windowEnd() - *since_ >= kRestart;
  }
}

std::vector<Suspect> TwoSenders::suspects(const Heard& heard) const {
  std::map<std::string, EventId> components;  // and one event type of each
  for (const SourceGraph::Publication& each : doubled_) {
    components.try_emplace(each.first, ids_.at(each).front());
  }
  const bool all = std::all_of(types_.begin(), types_.end(), [&](EventId id) {
    const EventType& type = model_->vocabulary().at(id);
    return heard.lastSeen(id).value_or(0) <= since_.value_or(0) ||
           doubled_.count({type.source, type.scope}) > 0;
  });
  const Reason reason = comesFromTwo(doubled_, all);
  std::vector<Suspect> suspects;
  for (const auto& [source, id] : components) {
    Suspect suspect;
    suspect.id = id;
    suspect.component = source;
    suspect.abnormal = lasting_;
    suspect.onset = since_.value_or(0);
    suspect.reason = reason;
    suspects.push_back(std::move(suspect));
  }
  return suspects;
}

}  // namespace self_awareness::core::evidence
