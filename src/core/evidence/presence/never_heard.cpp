#include "core/evidence/presence/never_heard.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <utility>

#include "core/evidence/explain/causes.h"

namespace self_awareness::core::evidence {
namespace {

/// Seconds, rounded: microseconds after a start mean nothing.
double toMilliseconds(double seconds) {
  return std::round(seconds * 1e3) / 1e3;
}

}  // namespace

NeverHeard::NeverHeard(const Model& model, const Limits& limits,
                       std::shared_ptr<const Upstream> upstream)
    : vocabulary_(model.vocabulary()),
      margin_of_waiting_(model.tuning().margin_of_waiting),
      alarm_later_(toNanoseconds(model.tuning().start_time)),
      accept_after_(model.tuning().accept_after * 1e9),
      upstream_(std::move(upstream)),
      heard_(model.components().size(), false),
      may_be_silent_(model.size(), false) {
  const Statistics& statistics = model.statistics();
  const Tuning& tuning = model.tuning();
  const auto recordings = static_cast<double>(statistics.recordings().size());
  std::vector<std::int64_t> silent;
  for (EventId id = 0; id < model.size(); ++id) {
    silent.push_back(std::llround(tuning.margin * static_cast<double>(model.longestGap(id))));
  }
  for (std::size_t track = 0; track < limits.tracks.size(); ++track) {
    if (model.finding(track) == Finding::kSilent && !std::isnan(limits.tracks[track])) {
      const EventId id = model.tracks()[track].to;
      silent[id] = toNanoseconds(std::min(limits.tracks[track], toSeconds(kLongestAge)));
    }
  }
  for (EventId id = 0; id < model.size(); ++id) {
    component_of_.push_back(model.componentIndex(id));
    Expected expected{id, std::numeric_limits<std::int64_t>::max(), 0, 0, 0, 0};
    const bool latched = model.vocabulary().isLatched(id);
    // Of what is held ready, there is one in each recording. Who else came less often in all of
    // training may stay away from one recording.
    bool always = latched
                      ? recordings >= tuning.fewest_starts
                      : model.vocabulary().isMessage(id) && recordings > 0 &&
                            static_cast<double>(statistics.type(id).gaps) >= tuning.arming_events;
    for (const Statistics::Recording& recording : statistics.recordings()) {
      const std::int64_t first = id < recording.firsts.size() ? recording.firsts[id] : -1;
      always = always && first >= 0;
      expected.shortest = std::min(expected.shortest, first);
      expected.longest = std::max(expected.longest, first);
    }
    if (id < limits.firsts.size()) {
      always = always && limits.firsts[id] >= 0;
      expected.shortest = std::min(expected.shortest, limits.firsts[id]);
      expected.longest = std::max(expected.longest, limits.firsts[id]);
    }
    // What is held ready later than a start takes, somebody asked for.
    if (always && (!latched || expected.longest <= alarm_later_)) {
      expected.late = std::llround(tuning.margin * static_cast<double>(expected.longest));
      // Who holds something ready may have been started before all that is recorded.
      expected.silent = latched ? alarm_later_ : silent[id];
      all_.push_back(expected);
    }
  }
  waiting_ = all_;
}

void NeverHeard::add(const Event& event) {
  start_ = start_.value_or(event.stamp);
  if (event.id < component_of_.size() && !vocabulary_.isLatched(event.id)) {
    heard_[component_of_[event.id]] = true;
  }
  for (std::vector<Expected>* list : {&waiting_, &missing_}) {
    const auto same = std::find_if(list->begin(), list->end(),
                                   [&](const Expected& each) { return each.id == event.id; });
    if (same != list->end()) {
      list->erase(same);
    }
  }
}

std::vector<bool> NeverHeard::expected() const {
  std::vector<bool> expected(component_of_.size(), false);
  for (const Expected& each : all_) {
    expected[each.id] = true;
  }
  return expected;
}

void NeverHeard::restart() {
  std::vector<Expected> again;
  std::copy_if(all_.begin(), all_.end(), std::back_inserter(again), [this](const Expected& each) {
    const auto isSame = [&](const Expected& other) { return other.id == each.id; };
    return !vocabulary_.isLatched(each.id) ||  // else it is not sent again
           std::any_of(waiting_.begin(), waiting_.end(), isSame) ||
           std::any_of(missing_.begin(), missing_.end(), isSame);
  });
  waiting_ = std::move(again);
  missing_.clear();
  heard_.assign(heard_.size(), false);
  start_.reset();
  paused_ = 0;
  share_ = 0;
}

void NeverHeard::closeWindow(std::int64_t end, std::int64_t settle_time) {
  end_ = end;
  const std::int64_t passed = end - start_.value_or(end) - paused_;
  const auto first_due = std::stable_partition(
      waiting_.begin(), waiting_.end(),
      [&](const Expected& expected) { return passed <= expected.due(settle_time); });
  if (first_due != waiting_.end()) {
    missing_.insert(missing_.end(), first_due, waiting_.end());
    waiting_.erase(first_due, waiting_.end());
    missing_ = rootFirst(std::move(missing_));
  }
  share_ = 0;
  for (Expected& expected : missing_) {
    const double alarm =
        std::max(margin_of_waiting_ * static_cast<double>(expected.started(settle_time)),
                 static_cast<double>(expected.due(settle_time) + alarm_later_));
    expected.share = static_cast<double>(passed) / alarm;
    // A recording may lack a topic, or what is held ready: that is cut off with a bag's begin. And
    // what never comes must not hide what breaks next.
    if (heard_[component_of_[expected.id]] || vocabulary_.isLatched(expected.id) ||
        static_cast<double>(passed) > alarm + accept_after_) {
      expected.share = std::min(expected.share, 1.0);
    }
    if (!may_be_silent_[expected.id]) {
      share_ = std::max(share_, expected.share);
    }
  }
}

std::vector<NeverHeard::Expected> NeverHeard::missing() const {
  std::vector<Expected> missing;
  std::copy_if(missing_.begin(), missing_.end(), std::back_inserter(missing),
               [this](const Expected& expected) { return !may_be_silent_[expected.id]; });
  return missing;
}

std::vector<NeverHeard::Expected> NeverHeard::rootFirst(std::vector<Expected> missing) const {
  std::vector<Expected> ordered;
  const auto is_root = [&](std::size_t root, std::size_t victim) {
    return upstream_->isUpstream(component_of_[missing[root].id],
                                 component_of_[missing[victim].id]);
  };
  for (const std::size_t next : evidence::rootFirst(missing.size(), is_root)) {
    ordered.push_back(missing[next]);
  }
  return ordered;
}

std::vector<std::pair<EventId, double>> NeverHeard::shares() const {
  std::vector<std::pair<EventId, double>> shares;
  for (const Expected& expected : missing()) {
    shares.emplace_back(expected.id, expected.share);
  }
  return shares;
}

Reason NeverHeard::reasonOf(const Expected& expected) const {
  Reason reason;
  reason.kind = Kind::kNeverCame;
  reason.unit = unit::kSeconds;
  reason.value = toSeconds(end_ - *start_);
  reason.lasted = reason.value;
  reason.usual_shortest = toSeconds(expected.shortest);
  reason.usual_longest = toSeconds(expected.longest);
  char text[100];
  std::snprintf(text, sizeof text, "not heard since the start, usually within %.3g to %.3g s",
                toMilliseconds(reason.usual_shortest), toMilliseconds(reason.usual_longest));
  reason.words = text;
  return reason;
}

std::vector<Suspect> NeverHeard::suspects() const {
  std::vector<Suspect> suspects;
  for (const Expected& expected : missing()) {
    Suspect suspect;
    suspect.id = expected.id;
    suspect.component = component(expected.id);
    suspect.abnormal = expected.share > 1;
    suspect.onset = *start_;
    suspect.reason = reasonOf(expected);
    suspects.push_back(suspect);
  }
  return suspects;
}

bool NeverHeard::isMissedBy(EventId id) const {
  const std::vector<Expected> all = missing();
  return id < component_of_.size() &&
         std::any_of(all.begin(), all.end(), [&](const Expected& expected) {
           return upstream_->isUpstream(component_of_[expected.id], component_of_[id]);
         });
}

const std::string& NeverHeard::component(EventId id) const {
  const EventType& type = vocabulary_.at(id);
  return componentOf(type.source, type.scope);
}

}  // namespace self_awareness::core::evidence
