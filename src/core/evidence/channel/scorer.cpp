#include "core/evidence/channel/scorer.h"

#include <algorithm>
#include <utility>

namespace self_awareness::core::evidence {
namespace {

constexpr double kForEver = 9e18;  // [ns]

}  // namespace

Scorer::Scorer(std::shared_ptr<const Model> model, std::int64_t window)
    : model_(std::move(model)),
      heard_(model_->size(), window,
             Stalls(model_->longestSilence(), model_->longestStall(), model_->tuning()),
             model_->tuning()),
      state_of_(model_->tracks().size()),
      evidence_(model_->tracks().size(), 0) {
  for (const auto& expectation : model_->expectations()) {
    for (const std::size_t track : expectation->tracks()) {
      state_of_[track] = states_.size();
    }
    states_.push_back(expectation->start());
    closing_.push_back(states_.back().get());
    if (states_.back()->listens()) {
      listening_.push_back(states_.back().get());
    }
  }
  for (EventId id = 0; id < model_->size(); ++id) {
    gone_after_.push_back(static_cast<std::int64_t>(std::min(
        model_->tuning().gone_gaps * static_cast<double>(model_->longestGap(id)), kForEver)));
  }
}

void Scorer::leaveOut(Finding finding) {
  closing_.clear();
  for (std::size_t k = 0; k < states_.size(); ++k) {
    if (model_->finding(model_->expectations()[k]->tracks().front()) != finding) {
      closing_.push_back(states_[k].get());
    }
  }
}

void Scorer::capAt(const Limits& limits) {
  for (const auto& state : states_) {
    state->capAt(limits.tracks);
  }
}

void Scorer::restart() {
  heard_.restart();
  std::fill(evidence_.begin(), evidence_.end(), 0);
  for (const auto& state : states_) {
    state->restart();
  }
}

void Scorer::disarm(EventId id) {
  for (const auto& state : states_) {
    state->disarm(id);
  }
}

// Loops that begin anew after a standstill have other phases.
void Scorer::disarmAll() {
  for (EventId id = 0; id < model_->size(); ++id) {
    disarm(id);
  }
}

void Scorer::forget(EventId id) {
  for (const auto& state : states_) {
    state->forget(id);
  }
}

void Scorer::forgetAttributes(EventId id) {
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const std::size_t track = model_->expectations()[k]->tracks().front();
    if (model_->tracks()[track].channel->isOfAttributes()) {
      states_[k]->forget(id);
    }
  }
}

std::vector<double>& Scorer::closeWindow(std::int64_t end) {
  heard_.closeWindow(end);
  for (ChannelState* const state : closing_) {
    state->closeWindow(heard_, evidence_);
  }
  return evidence_;
}

bool Scorer::isCertain(std::size_t track, double limit) const {
  return stateOf(track).isCertain(track, limit, heard_);
}

std::optional<std::int64_t> Scorer::onset(std::size_t track) const {
  const Finding finding = model_->finding(track);
  return finding == Finding::kSilent || finding == Finding::kAbsent
             ? heard_.lastSeen(model_->tracks()[track].to)
             : stateOf(track).onset(track);
}

void Scorer::explain(std::size_t track, const RecentEvents& events, Suspect& suspect) const {
  stateOf(track).explain(track, heard_, events, suspect);
  if (isSilence(suspect.reason.kind) && heard_.hasSeen(suspect.id)) {
    suspect.reason.silence = toSeconds(heard_.silence(suspect.id));
  }
}

}  // namespace self_awareness::core::evidence
