#include "core/evidence/blame/new_mode.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <utility>

namespace self_awareness::core::evidence {
namespace {

/// Whether evidence says that something has not come, or too seldom, without being asked for.
bool isOfSilence(Finding finding) {
  return finding == Finding::kFewer || (isAbsence(finding) && finding != Finding::kUnanswered);
}

/// When the last of them was heard [ns].
std::int64_t lastOf(const std::vector<EventId>& ids, const Heard& heard) {
  std::int64_t last = 0;
  for (const EventId id : ids) {
    last = std::max(last, heard.stamps()[id]);
  }
  return last;
}

}  // namespace

NewMode::NewMode(std::shared_ptr<const Model> model, std::shared_ptr<const Upstream> upstream)
    : model_(std::move(model)),
      upstream_(std::move(upstream)),
      excused_until_(model_->size(), 0) {}

std::optional<Silent> NewMode::excuse(std::vector<double>& shares, const Limits& limits,
                                      const Scorer& scorer,
                                      const std::vector<bool>& may_be_silent) {
  if (upstream_->empty()) {
    return std::nullopt;
  }
  const Heard& heard = scorer.heard();
  const std::set<EventId> stopped =
      find(silent(shares, limits, heard, may_be_silent), shares, heard);
  if (stopped.empty() || accepted_.coversMode(namesOf(stopped))) {  // that is no news
    return std::nullopt;
  }
  takeBack(stopped, shares, heard, std::numeric_limits<std::int64_t>::max());
  Silent found;
  found.others_go_on = true;
  found.components = namesOf(stopped);
  for (const EventId id : stopped) {
    found.since = std::max(found.since, *heard.lastSeen(id));
  }
  return found;
}

std::vector<std::string> NewMode::excuseAccepted(std::vector<double>& shares, const Limits& limits,
                                                 const Scorer& scorer,
                                                 const std::vector<bool>& may_be_silent) {
  if (accepted_.list().empty() || upstream_->empty()) {
    return {};
  }
  const Heard& heard = scorer.heard();
  const std::vector<EventId> silent = this->silent(shares, limits, heard, may_be_silent);
  std::set<EventId> stopped = find(silent, shares, heard);
  if (!stopped.empty() && !accepted_.coversMode(namesOf(stopped))) {
    return {};
  }
  for (const Acceptance& mode : accepted_.list()) {
    stopped.merge(offIn(mode, silent, heard));
  }
  const std::int64_t begun = lastOf({stopped.begin(), stopped.end()}, heard);
  takeBack(stopped, shares, heard, begun + toNanoseconds(model_->tuning().start_time));
  return namesOf(stopped);
}

std::set<EventId> NewMode::offIn(const Acceptance& mode, const std::vector<EventId>& silent,
                                 const Heard& heard) const {
  const auto isOfIt = [&](EventId id) {
    return std::binary_search(mode.together.begin(), mode.together.end(), model_->component(id));
  };
  std::int64_t latest = 0;
  std::set<std::size_t> seen;
  for (EventId id = 0; id < model_->size(); ++id) {
    if (heard.hasSeen(id) && isOfIt(id)) {
      latest = std::max(latest, heard.stamps()[id]);
      seen.insert(model_->componentIndex(id));
    }
  }
  std::set<EventId> off;
  if (static_cast<double>(seen.size()) < model_->tuning().fewest_busy) {
    return off;
  }
  for (const EventId id : silent) {
    const auto others_longer = static_cast<double>(latest - heard.stamps()[id]);
    if (isOfIt(id) && others_longer <= static_cast<double>(heard.silence(id)) / 2 &&
        others_longer <= static_cast<double>(kRateSpan) + model_->meanGap(id)) {
      off.insert(id);
    }
  }
  return off;
}

void NewMode::accept(const Acceptances& accepted) {
  accepted_ = {};
  for (const Acceptance& each : accepted.list()) {
    if (each.extent() == Acceptance::Extent::kMode) {
      accepted_.add(each);
    }
  }
}

std::set<EventId> NewMode::find(const std::vector<EventId>& silent,
                                const std::vector<double>& shares, const Heard& heard) {
  const std::int64_t now = heard.windowEnd();
  std::set<EventId> stopped = this->stopped(silent, shares, heard);
  // They do not come back all at once.
  for (const EventId id : silent) {
    if (stopped.count(id) > 0) {
      excused_until_[id] = now + kRateSpan + static_cast<std::int64_t>(model_->meanGap(id));
    } else if (now < excused_until_[id]) {
      stopped.insert(id);
    }
  }
  return stopped;
}

void NewMode::takeBack(const std::set<EventId>& stopped, std::vector<double>& shares,
                       const Heard& heard, std::int64_t until) const {
  const std::set<std::size_t> components = componentsOf({stopped.begin(), stopped.end()});
  const auto hearsThem = [&](EventId id) {
    return std::any_of(components.begin(), components.end(), [&](std::size_t component) {
      return upstream_->isUpstream(component, model_->componentIndex(id));
    });
  };
  const std::int64_t stop = lastOf({stopped.begin(), stopped.end()}, heard);
  const auto began_before = [&](EventId id) {
    return stop - heard.stamps()[id] > kRateSpan + model_->longestGap(id);
  };
  for (std::size_t track = 0; track < shares.size(); ++track) {
    const EventId id = model_->tracks()[track].to;
    if (shares[track] > 0 &&
        (stopped.count(id) > 0 || (isOfSilence(model_->finding(track)) && !began_before(id) &&
                                   heard.stamps()[id] <= until && hearsThem(id)))) {
      shares[track] = 0;
    }
  }
}

std::vector<std::string> NewMode::namesOf(const std::set<EventId>& ids) const {
  std::vector<std::string> names;
  for (const std::size_t component : componentsOf({ids.begin(), ids.end()})) {
    names.push_back(model_->components()[component]);
  }
  std::sort(names.begin(), names.end());
  return names;
}

void NewMode::restart() {
  std::fill(excused_until_.begin(), excused_until_.end(), 0);
}

std::vector<EventId> NewMode::silent(const std::vector<double>& shares, const Limits& limits,
                                     const Heard& heard,
                                     const std::vector<bool>& may_be_silent) const {
  const double rare = std::log(model_->tuning().rare_silence);
  std::vector<bool> owes = may_be_silent;
  for (std::size_t track = 0; track < model_->tracks().size(); ++track) {
    const bool owed = model_->finding(track) == Finding::kUnanswered && shares[track] > 1;
    owes[model_->tracks()[track].to] = owes[model_->tracks()[track].to] || owed;
  }
  std::vector<EventId> silent;
  for (std::size_t track = 0; track < model_->tracks().size(); ++track) {
    const EventId id = model_->tracks()[track].to;
    if (model_->finding(track) == Finding::kSilent && !std::isnan(limits.tracks[track]) &&
        !owes[id] && heard.hasSeen(id) && model_->logSurvival(id, heard.listenedFor(id)) < rare) {
      silent.push_back(id);
    }
  }
  return silent;
}

std::set<EventId> NewMode::stopped(const std::vector<EventId>& silent,
                                   const std::vector<double>& shares, const Heard& heard) {
  std::set<EventId> stopped;
  if (static_cast<double>(componentsOf(silent).size()) < model_->tuning().fewest_busy) {
    return stopped;
  }
  std::map<std::vector<EventId>, bool> answers;  // most stop with the same ones
  for (std::size_t track = 0; track < shares.size(); ++track) {
    const EventId id = model_->tracks()[track].to;
    const Finding finding = model_->finding(track);
    if (shares[track] <= 1 || !heard.hasSeen(id) || stopped.count(id) > 0 ||
        (finding != Finding::kSilent && finding != Finding::kAbsent)) {
      continue;
    }
    const std::vector<EventId> together = stoppedWith(id, silent, heard);
    const auto [answer, is_new] = answers.try_emplace(together, false);
    if (is_new && areUnrelated(together, heard) && othersGoOn(together, heard)) {
      answer->second = true;
      stopped.insert(together.begin(), together.end());
    }
  }
  return stopped;
}

std::vector<EventId> NewMode::stoppedWith(EventId id, const std::vector<EventId>& silent,
                                          const Heard& heard) const {
  const auto stopped = static_cast<double>(*heard.lastSeen(id));
  std::vector<EventId> together;
  for (const EventId other : silent) {
    const double earlier = stopped - static_cast<double>(*heard.lastSeen(other));
    const double usual = model_->meanGap(earlier > 0 ? other : id);
    if (std::abs(earlier) <= static_cast<double>(kRateSpan) + usual) {
      together.push_back(other);
    }
  }
  return together;
}

bool NewMode::areUnrelated(const std::vector<EventId>& ids, const Heard& heard) const {
  const std::set<std::size_t> components = componentsOf(ids);
  if (static_cast<double>(components.size()) < model_->tuning().fewest_busy) {
    return false;
  }
  std::vector<bool> may_have_died = mayHaveDied(lastOf(ids, heard), heard);
  for (const std::size_t component : components) {
    may_have_died[component] = true;
  }
  const auto isRoot = [&](std::size_t component) {
    for (std::size_t other = 0; other < may_have_died.size(); ++other) {
      if (may_have_died[other] && upstream_->isUpstream(other, component)) {
        return false;
      }
    }
    return true;
  };
  return static_cast<double>(std::count_if(components.begin(), components.end(), isRoot)) >=
         model_->tuning().fewest_busy;
}

std::vector<bool> NewMode::mayHaveDied(std::int64_t by, const Heard& heard) const {
  std::vector<bool> as_usual(model_->components().size(), false);
  std::vector<bool> since(model_->components().size(), false);
  for (EventId id = 0; id < model_->size(); ++id) {
    if (const std::optional<std::int64_t> last = heard.lastSeen(id)) {
      const std::size_t component = model_->componentIndex(id);
      since[component] = since[component] || *last > by;
      as_usual[component] =
          as_usual[component] || by - *last <= kRateSpan + model_->longestGap(id);
    }
  }
  std::transform(as_usual.begin(), as_usual.end(), since.begin(), as_usual.begin(),
                 [](bool usual, bool later) { return usual && !later; });
  return as_usual;
}

std::set<std::size_t> NewMode::componentsOf(const std::vector<EventId>& ids) const {
  std::set<std::size_t> components;
  for (const EventId id : ids) {
    components.insert(model_->componentIndex(id));
  }
  return components;
}

bool NewMode::othersGoOn(const std::vector<EventId>& stopped, const Heard& heard) const {
  const std::int64_t last = *std::max_element(heard.stamps(), heard.stamps() + model_->size());
  return last - lastOf(stopped, heard) > heard.windowEnd() - last;
}

}  // namespace self_awareness::core::evidence
