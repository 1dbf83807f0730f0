#include "core/evidence/excuse/new_mode.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace self_awareness::core::evidence {
namespace {

/// When the last of them was heard [ns].
std::int64_t lastOf(const std::vector<EventId>& ids, const Heard& heard) {
  std::int64_t last = 0;
  for (const EventId id : ids) {
    last = std::max(last, heard.stamps()[id]);
  }
  return last;
}

}  // namespace

std::optional<std::int64_t> NewMode::closeWindow(const Unusual& window, Judgement& judgement) {
  stopped_.clear();
  stopped_at_.clear();
  if (!window.isAbnormal() || window.causes.areGuessed()) {
    return std::nullopt;
  }
  missed_ = missedBy(window);
  const Ids silent = this->silent(window);
  std::set<EventId> stopped = this->stopped(silent, window);
  stopped_.assign(stopped.begin(), stopped.end());
  is_accepted_ = stopped.empty() || accepted_.coversMode(namesOf(stopped_));
  if (is_accepted_) {
    for (const Acceptance& mode : accepted_.list()) {
      addOff(mode, silent, window.heard(), stopped);
    }
    stopped_.assign(stopped.begin(), stopped.end());
  }
  if (stopped_.empty()) {
    return std::nullopt;
  }
  since_ = lastOf(stopped_, window.heard());
  std::int64_t first = since_;  // groups may have stopped at several moments
  for (const EventId id : stopped_) {
    const std::int64_t stamp = window.heard().stamps()[id];
    std::int64_t& last = stopped_at_[model_->componentIndex(id)];
    last = std::max(last, stamp);
    first = std::min(first, stamp);
  }
  if (is_accepted_) {
    judgement.mode = namesOf(stopped_);
  } else if (!judgement.silent) {  // else it was there before all fell silent
    judgement.silent = Silent{{}, namesOf(stopped_), since_, true};
  }
  return is_accepted_ ? std::numeric_limits<std::int64_t>::min() : first;
}

bool NewMode::explains(const Excess& excess, const Unusual& window) const {
  const std::int64_t last = window.heard().stamps()[excess.id];
  if (std::binary_search(stopped_.begin(), stopped_.end(), excess.id)) {
    return is_accepted_ || beganSince(last, excess, *model_);
  }
  const bool went_on = is_accepted_ && last > since_ + toNanoseconds(model_->tuning().start_time);
  if (!excess.isTooLittle() || excess.finding() == Finding::kUnanswered || went_on) {
    return false;
  }
  return std::any_of(stopped_at_.begin(), stopped_at_.end(), [&](const auto& stopped) {
    return window.causes.isUpstream(stopped.first, excess.component) &&
           stopped.second - last <= model_->longestPause(excess.id) &&
           !wasMissed(excess.id, stopped.second, window);
  });
}

void NewMode::accept(const Acceptances& accepted) {
  accepted_ = {};
  for (const Acceptance& each : accepted.list()) {
    if (each.extent() == Acceptance::Extent::kMode) {
      accepted_.add(each);
    }
  }
}

void NewMode::restart() {
  std::fill(excused_until_.begin(), excused_until_.end(), 0);
}

std::set<std::size_t> NewMode::componentsOf(const Ids& ids) const {
  std::set<std::size_t> components;
  for (const EventId id : ids) {
    components.insert(model_->componentIndex(id));
  }
  return components;
}

std::vector<std::string> NewMode::namesOf(const Ids& ids) const {
  std::set<std::string> names;
  for (const EventId id : ids) {
    names.insert(model_->component(id));
  }
  return {names.begin(), names.end()};
}

NewMode::Ids NewMode::silent(const Unusual& window) const {
  std::vector<bool> owes = window.may_be_silent;
  for (const Excess& excess : window.excesses) {
    if (excess.finding() == Finding::kUnanswered && excess.share > 1) {
      owes[excess.id] = true;
    }
  }
  Ids silent;
  for (EventId id = 0; id < model_->size(); ++id) {
    if (!std::isnan(window.limits_of_silence[id]) && !owes[id] && window.heard().hasSeen(id) &&
        model_->isRare(id, window.heard().listenedFor(id))) {
      silent.push_back(id);
    }
  }
  return silent;
}

std::set<EventId> NewMode::stopped(const Ids& silent, const Unusual& window) {
  const Heard& heard = window.heard();
  const std::int64_t now = heard.windowEnd();
  std::set<EventId> stopped;
  for (Ids& group : groups(silent, window)) {
    // Who stopped with many did not stop with few, too.
    group.erase(std::remove_if(group.begin(), group.end(),
                               [&](EventId id) { return stopped.count(id) > 0; }),
                group.end());
    if (areUnrelated(group, window) && othersGoOn(group, heard)) {
      stopped.insert(group.begin(), group.end());
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
  return stopped;
}

std::vector<NewMode::Ids> NewMode::groups(const Ids& silent, const Unusual& window) const {
  std::set<Ids> groups;  // most stop with the same ones
  std::set<EventId> seen;
  for (const Excess& excess : window.excesses) {
    const Finding finding = excess.finding();
    if (excess.share > 1 && window.heard().hasSeen(excess.id) &&
        (finding == Finding::kSilent || finding == Finding::kAbsent) &&
        seen.insert(excess.id).second) {
      groups.insert(stoppedWith(excess.id, silent, window));
    }
  }
  std::vector<Ids> ordered(groups.begin(), groups.end());
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const Ids& a, const Ids& b) { return a.size() > b.size(); });
  return ordered;
}

NewMode::Ids NewMode::stoppedWith(EventId id, const Ids& silent, const Unusual& window) const {
  const auto stamps = window.heard().stamps();
  Ids together;
  for (const EventId other : silent) {
    const EventId first = stamps[other] < stamps[id] ? other : id;
    const std::int64_t apart = std::abs(stamps[other] - stamps[id]);
    if (apart <= kRateSpan + static_cast<std::int64_t>(model_->meanGap(first)) &&
        !wasMissed(first, stamps[first] + apart, window)) {
      together.push_back(other);
    }
  }
  const std::int64_t last = lastOf(together, window.heard());
  together.erase(std::remove_if(together.begin(), together.end(),
                                [&](EventId other) { return wasMissed(other, last, window); }),
                 together.end());
  return together;
}

std::vector<std::int64_t> NewMode::missedBy(const Unusual& window) const {
  std::vector<std::int64_t> missed(model_->size(), kNotYet);
  for (const Excess& excess : window.excesses) {
    if (excess.abnormal == kNotYet || !excess.isAbsence()) {
      continue;
    }
    const std::int64_t usual = model_->longestPause(excess.id);
    for (EventId id = 0; id < model_->size(); ++id) {
      const std::int64_t last = window.heard().stamps()[id];
      const std::size_t component = model_->componentIndex(id);
      // Who fell silent long before it was heard last does not wait for it.
      if (window.heard().hasSeen(id) && last < excess.abnormal && last - excess.onset <= usual &&
          (component == excess.component ||
           window.causes.isUpstream(component, excess.component))) {
        missed[id] = std::min(missed[id], excess.abnormal);
      }
    }
  }
  return missed;
}

bool NewMode::wasMissed(EventId id, std::int64_t stamp, const Unusual& window) const {
  const std::int64_t silence = stamp - window.heard().stamps()[id];
  return silence > 0 &&
         (missed_[id] <= stamp || toSeconds(silence) > window.limits_of_silence[id]);
}

bool NewMode::areUnrelated(const Ids& ids, const Unusual& window) const {
  const std::set<std::size_t> components = componentsOf(ids);
  if (static_cast<double>(components.size()) < model_->tuning().several) {
    return false;
  }
  // Judged or not, who was not heard since, but as lately as is usual, may have died.
  const std::int64_t stop = lastOf(ids, window.heard());
  std::vector<bool> as_usual(model_->components().size(), false);
  std::vector<bool> since(model_->components().size(), false);
  for (EventId id = 0; id < model_->size(); ++id) {
    if (const std::optional<std::int64_t> last = window.heard().lastSeen(id)) {
      const std::size_t component = model_->componentIndex(id);
      since[component] = since[component] || *last > stop;
      as_usual[component] = as_usual[component] || stop - *last <= model_->longestPause(id);
    }
  }
  const auto isRoot = [&](std::size_t component) {
    for (std::size_t other = 0; other < since.size(); ++other) {
      const bool may_have_died = components.count(other) > 0 || (as_usual[other] && !since[other]);
      if (may_have_died && window.causes.isUpstream(other, component)) {
        return false;
      }
    }
    return true;
  };
  return static_cast<double>(std::count_if(components.begin(), components.end(), isRoot)) >=
         model_->tuning().several;
}

bool NewMode::othersGoOn(const Ids& ids, const Heard& heard) const {
  const std::int64_t last = *std::max_element(heard.stamps(), heard.stamps() + model_->size());
  return last - lastOf(ids, heard) > heard.windowEnd() - last;
}

void NewMode::addOff(const Acceptance& mode, const Ids& silent, const Heard& heard,
                     std::set<EventId>& off) const {
  const auto isOfIt = [&](EventId id) {
    return std::binary_search(mode.together.begin(), mode.together.end(), model_->component(id));
  };
  Ids seen;
  for (EventId id = 0; id < model_->size(); ++id) {
    if (heard.hasSeen(id) && isOfIt(id)) {
      seen.push_back(id);
    }
  }
  if (static_cast<double>(componentsOf(seen).size()) < model_->tuning().several) {
    return;
  }
  const std::int64_t latest = lastOf(seen, heard);
  for (const EventId id : silent) {
    const auto others_longer = static_cast<double>(latest - heard.stamps()[id]);
    if (isOfIt(id) && others_longer <= static_cast<double>(heard.silence(id)) / 2 &&
        others_longer <= static_cast<double>(kRateSpan) + model_->meanGap(id)) {
      off.insert(id);
    }
  }
}

}  // namespace self_awareness::core::evidence
