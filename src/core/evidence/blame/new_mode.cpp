#include "core/evidence/blame/new_mode.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace self_awareness::core::evidence {
namespace {

/// Whether evidence says that something has not come, or too seldom.
bool isOfSilence(Finding finding) {
  return finding == Finding::kSilent || finding == Finding::kFewer ||
         finding == Finding::kUnanswered;
}

}  // namespace

NewMode::NewMode(std::shared_ptr<const Model> model, std::shared_ptr<const SourceGraph> graph)
    : model_(std::move(model)), graph_(std::move(graph)), excused_until_(model_->size(), 0) {}

std::optional<Silent> NewMode::excuse(std::vector<double>& shares, const Limits& limits,
                                      const Scorer& scorer) {
  if (graph_->empty()) {
    return std::nullopt;
  }
  const std::int64_t now = scorer.heard().windowEnd();
  const std::vector<EventId> silent = this->silent(limits, scorer);
  std::set<EventId> stopped;
  for (std::size_t track = 0; track < shares.size(); ++track) {
    const EventId id = model_->tracks()[track].to;
    if (shares[track] <= 1 || model_->finding(track) != Finding::kSilent ||
        stopped.count(id) > 0) {
      continue;
    }
    const std::vector<EventId> together = stoppedWith(id, silent, scorer);
    if (areUnrelated(together) && othersGoOn(together, scorer.heard())) {
      stopped.insert(together.begin(), together.end());
    }
  }
  // They do not come back all at once.
  for (const EventId id : silent) {
    if (stopped.count(id) > 0) {
      excused_until_[id] = now + kRateSpan + static_cast<std::int64_t>(model_->meanGap(id));
    } else if (now < excused_until_[id]) {
      stopped.insert(id);
    }
  }
  if (stopped.empty()) {
    return std::nullopt;
  }
  std::set<std::string> components;
  for (const EventId id : stopped) {
    components.insert(model_->component(id));
  }
  const auto hearsThem = [&](EventId id) {
    return std::any_of(components.begin(), components.end(), [&](const std::string& component) {
      return graph_->isUpstream(component, model_->component(id));
    });
  };
  for (std::size_t track = 0; track < shares.size(); ++track) {
    const EventId id = model_->tracks()[track].to;
    if (shares[track] > 0 &&
        (stopped.count(id) > 0 || (isOfSilence(model_->finding(track)) && hearsThem(id)))) {
      shares[track] = 0;
    }
  }
  Silent found;
  found.others_go_on = true;
  found.components.assign(components.begin(), components.end());
  for (const EventId id : stopped) {
    found.since = std::max(found.since, *scorer.heard().lastSeen(id));
  }
  return found;
}

void NewMode::restart() {
  std::fill(excused_until_.begin(), excused_until_.end(), 0);
}

std::vector<EventId> NewMode::silent(const Limits& limits, const Scorer& scorer) const {
  const double rare = std::log(model_->tuning().rare_silence);
  std::vector<EventId> silent;
  for (std::size_t track = 0; track < model_->tracks().size(); ++track) {
    const EventId id = model_->tracks()[track].to;
    if (model_->finding(track) == Finding::kSilent && !std::isnan(limits.tracks[track]) &&
        scorer.heard().hasSeen(id) && model_->logSurvival(id, scorer.heard().silence(id)) < rare) {
      silent.push_back(id);
    }
  }
  return silent;
}

std::vector<EventId> NewMode::stoppedWith(EventId id, const std::vector<EventId>& silent,
                                          const Scorer& scorer) const {
  const auto stopped = static_cast<double>(*scorer.heard().lastSeen(id));
  std::vector<EventId> together;
  for (const EventId other : silent) {
    const double earlier = stopped - static_cast<double>(*scorer.heard().lastSeen(other));
    const double usual = model_->meanGap(earlier > 0 ? other : id);
    if (std::abs(earlier) <= static_cast<double>(kRateSpan) + usual) {
      together.push_back(other);
    }
  }
  return together;
}

bool NewMode::areUnrelated(const std::vector<EventId>& ids) const {
  std::set<std::string> components;
  for (const EventId id : ids) {
    components.insert(model_->component(id));
  }
  const auto isRoot = [&](const std::string& component) {
    return std::none_of(components.begin(), components.end(), [&](const std::string& other) {
      return graph_->isUpstream(other, component);
    });
  };
  return static_cast<double>(std::count_if(components.begin(), components.end(), isRoot)) >=
         model_->tuning().fewest_busy;
}

bool NewMode::othersGoOn(const std::vector<EventId>& stopped, const Heard& heard) const {
  const std::int64_t* stamps = heard.stamps();
  std::int64_t stopped_at = 0;
  for (const EventId id : stopped) {
    stopped_at = std::max(stopped_at, stamps[id]);
  }
  const std::int64_t last = *std::max_element(stamps, stamps + model_->size());
  return last - stopped_at > heard.windowEnd() - last;
}

}  // namespace self_awareness::core::evidence
