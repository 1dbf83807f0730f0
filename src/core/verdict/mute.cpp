#include "self_awareness/core/verdict/mute.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "self_awareness/core/verdict/acceptance.h"
#include "self_awareness/core/verdict/dependents.h"

namespace self_awareness::core {

const Mute* Mutes::add(const Mute& mute) {
  const auto old = std::find_if(mutes_.begin(), mutes_.end(),
                                [&](const Mute& each) { return each.isLike(mute); });
  if (old == mutes_.end()) {
    if (mutes_.size() >= kMost) {
      return nullptr;
    }
    mutes_.push_back(mute);
    return &mutes_.back();
  }
  if (old->by == mute.by || old->until <= mute.until) {
    Mute renewed = mute;
    renewed.alarms = old->alarms;
    renewed.suspicions = old->suspicions;
    renewed.has_muted = active_ && mutes_.begin() + static_cast<std::ptrdiff_t>(*active_) == old;
    *old = std::move(renewed);  // in its place: what stands is muted by it as before
  }
  return &*old;
}

std::optional<Mute> Mutes::end(const Mute& like) {
  const auto found = std::find_if(mutes_.begin(), mutes_.end(),
                                  [&](const Mute& mute) { return mute.isLike(like); });
  if (found == mutes_.end()) {
    return std::nullopt;
  }
  Mute ended = std::move(*found);
  mutes_.erase(found);
  active_.reset();
  return ended;
}

std::vector<Mute> Mutes::advance(std::int64_t now) {
  std::vector<Mute> over;
  for (const Mute& mute : std::vector<Mute>(mutes_)) {
    if (mute.until <= now) {
      over.push_back(*end(mute));
    }
  }
  return over;
}

std::vector<Mute> Mutes::onStanding(const std::optional<Alarm>& standing,
                                    const Vocabulary& vocabulary, const SourceGraph& graph) {
  const bool was_muted = active_.has_value();
  const bool is_left = standing && was_muted && standing->suspects.empty() &&
                       standing->culprit == culprit_;  // of the one before
  if (!standing || (is_left && !areMuted(standing->later, *standing, vocabulary, graph))) {
    active_.reset();
  } else if (!is_left) {
    active_ = muteOf(*standing, vocabulary, graph);
  }
  culprit_ = standing ? standing->culprit : "";
  std::vector<Mute> over;
  if (active_ && std::exchange(counted_, standing->id) != standing->id) {
    Mute& mute = mutes_[*active_];
    ++(standing->level == Alarm::Level::kAlarm ? mute.alarms : mute.suspicions);
    mute.has_muted = true;
  }
  for (const Mute& mute : std::vector<Mute>(mutes_)) {
    if (!standing && mute.until_over && mute.has_muted) {
      over.push_back(*end(mute));
    }
  }
  return over;
}

const Mute* Mutes::active() const {
  return active_ ? &mutes_[*active_] : nullptr;
}

const Mute* Mutes::ofComponent(const std::string& component) const {
  const auto found = std::find_if(mutes_.begin(), mutes_.end(), [&](const Mute& mute) {
    return mute.topic.empty() && !mute.kind && matchesPattern(mute.component, component);
  });
  return found == mutes_.end() ? nullptr : &*found;
}

std::optional<std::size_t> Mutes::muteOf(const std::string& component, const std::string& topic,
                                         Kind kind) const {
  const auto found = std::find_if(mutes_.begin(), mutes_.end(), [&](const Mute& mute) {
    return matchesPattern(mute.component, component) && matchesPattern(mute.topic, topic) &&
           mute.kind.value_or(kind) == kind;
  });
  return found == mutes_.end() ? std::nullopt : std::optional<std::size_t>(found - mutes_.begin());
}

std::optional<std::size_t> Mutes::muteOf(const Suspect& suspect,
                                         const Vocabulary& vocabulary) const {
  return muteOf(suspect.component,
                suspect.id < vocabulary.size() ? vocabulary.at(suspect.id).scope : "",
                suspect.reason.kind);
}

std::optional<std::size_t> Mutes::muteOf(const Alarm& alarm, const Vocabulary& vocabulary,
                                         const SourceGraph& graph) const {
  std::vector<Suspect> suspects = alarm.suspects;
  suspects.insert(suspects.end(), alarm.later.begin(), alarm.later.end());
  const auto culprit = std::find_if(suspects.begin(), suspects.end(), [&](const Suspect& suspect) {
    return !alarm.culprit.empty() && suspect.component == alarm.culprit;
  });
  // Of an alarm of before the start, the suspects of then are not known.
  const std::optional<std::size_t> muted = culprit == suspects.end()
                                               ? muteOf(alarm.culprit, "", alarm.kind)
                                               : muteOf(*culprit, vocabulary);
  return areMuted(suspects, alarm, vocabulary, graph) ? muted : std::nullopt;
}

bool Mutes::areMuted(const std::vector<Suspect>& suspects, const Alarm& alarm,
                     const Vocabulary& vocabulary, const SourceGraph& graph) const {
  if (alarm.culprit.empty()) {
    return true;
  }
  const std::set<std::string> dependent = dependentsOf(graph, alarm.culprit);
  return std::all_of(suspects.begin(), suspects.end(), [&](const Suspect& suspect) {
    return !suspect.abnormal || suspect.component == alarm.culprit ||
           dependent.count(suspect.component) > 0 || muteOf(suspect, vocabulary);
  });
}

}  // namespace self_awareness::core
