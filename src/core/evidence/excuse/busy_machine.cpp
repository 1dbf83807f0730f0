#include "core/evidence/excuse/busy_machine.h"

#include <algorithm>
#include <set>
#include <utility>

namespace self_awareness::core::evidence {
namespace {

/// Whether a busy machine can be why: who has no time is late, or silent, and does not send too
/// often.
bool mayBeBusy(const Excess& excess) {
  return excess.channel->mayBeLate() && excess.channel->kind() != Kind::kFast;
}

/// Whether what is unusual is that something came late, or too seldom.
bool isOfLate(const Excess& excess, const Unusual& window) {
  if (excess.isAbsence() || !mayBeBusy(excess)) {
    return false;
  }
  Suspect suspect;
  suspect.id = excess.id;
  window.scorer.explain(excess.track, window.events, suspect);
  return suspect.reason.kind != Kind::kEarly;
}

}  // namespace

BusyMachine::BusyMachine(std::shared_ptr<const Model> model)
    : model_(std::move(model)), lateness_(model_->components().size()) {}

void BusyMachine::restart() {
  busy_since_.reset();
  lateness_.assign(lateness_.size(), {});
  starved_since_.reset();
}

std::optional<std::int64_t> BusyMachine::closeWindow(const Unusual& window, Judgement& judgement) {
  std::optional<Busy> busy = late(window);
  if (const auto since = starvedSince(window.heard())) {
    busy = busy.value_or(Busy{0, 0, 0, *since});
    busy->since = std::min(busy->since, *since);
    busy->starved = toSeconds(window.heard().windowEnd() - *since);
  }
  if (!busy) {
    return std::nullopt;
  }
  judgement.busy = busy;
  since_ = busy->since;
  return since_;
}

bool BusyMachine::explains(const Excess& excess, const Unusual& window) const {
  // Who fell silent shortly before died, though it could have waited.
  return excess.onset >= since_ && mayBeBusy(excess) &&
         (!excess.isAbsence() || mayHold(excess.id, window.heard()));
}

std::optional<std::int64_t> BusyMachine::starvedSince(const Heard& heard) {
  const std::int64_t waited = heard.starved();
  // Processes that wait for less are forgiven, and not spoken of: that comes and goes wherever
  // more is begun at once than there are processors.
  if (static_cast<double>(waited) < model_->tuning().usual * static_cast<double>(kRateSpan)) {
    starved_since_.reset();
  } else {
    starved_since_ = starved_since_.value_or(heard.windowEnd() - waited);
  }
  return starved_since_;
}

std::optional<Busy> BusyMachine::late(const Unusual& window) {
  const Heard& heard = window.heard();
  const std::int64_t now = heard.windowEnd();
  std::vector<bool> silent(lateness_.size(), false);
  for (const Excess& excess : window.excesses) {
    if (excess.finding() == Finding::kSilent && excess.share > 1 &&
        excess.excused != Excused::kAccepted) {
      // Silences of a busy machine end soon.
      silent[excess.component] =
          silent[excess.component] || !busy_since_ || !mayHold(excess.id, heard);
    }
  }
  noteLate(window);
  Busy busy;
  std::vector<std::size_t> late;
  std::vector<std::int64_t> since;
  for (std::size_t component = 0; component < lateness_.size(); ++component) {
    if (!silent[component] && isRecent(lateness_[component].last, now)) {
      late.push_back(component);
      since.push_back(lateness_[component].since);
    }
  }
  std::set<std::size_t> seen;
  for (EventId id = 0; id < model_->size() && !late.empty(); ++id) {
    if (heard.hasSeen(id)) {
      seen.insert(model_->componentIndex(id));
    }
  }
  busy.late = late.size();
  busy.components = seen.size();
  const Tuning& tuning = model_->tuning();
  // Where more are silent, something else is wrong.
  const bool many =
      static_cast<double>(busy.late) >= tuning.several &&
      static_cast<double>(busy.late) * tuning.busy_one_in >=
          static_cast<double>(busy.components) &&
      static_cast<std::ptrdiff_t>(busy.late) >= std::count(silent.begin(), silent.end(), true);
  const bool is_abnormal =
      std::any_of(window.excesses.begin(), window.excesses.end(), [](const Excess& excess) {
        return excess.share > 1 && excess.excused != Excused::kAccepted;
      });
  if (!many || (!busy_since_ && !(is_abnormal && areUnrelated(late, silent, window.causes)))) {
    busy_since_.reset();
    return std::nullopt;
  }
  if (!busy_since_) {
    const auto middle = since.begin() + static_cast<std::ptrdiff_t>(since.size() / 2);
    std::nth_element(since.begin(), middle, since.end());
    busy_since_ = *middle - kOneCause;  // a load that grows makes one after the other late
  }
  busy.since = *busy_since_;
  return busy;
}

bool BusyMachine::isRecent(std::int64_t stamp, std::int64_t now) {
  return stamp != kNever && now - stamp <= kOneCause;
}

void BusyMachine::noteLate(const Unusual& window) {
  const std::int64_t now = window.heard().windowEnd();
  for (const Excess& excess : window.excesses) {
    Lateness& lateness = lateness_[excess.component];
    // What was late for long is news no more, but who is held up falls silent now and then.
    const bool is_held_up =
        busy_since_ && excess.finding() == Finding::kSilent && mayHold(excess.id, window.heard());
    const std::size_t after = model_->componentIndex(excess.from);
    const bool is_between = excess.finding() == Finding::kBetween;
    const bool is_known =  // to say why takes time
        lateness.last == now && (!is_between || lateness.after.count(after) > 0);
    if (is_known || excess.excused == Excused::kAccepted ||
        excess.share <= model_->tuning().near_limit || !(is_held_up || isOfLate(excess, window))) {
      continue;
    }
    if (!isRecent(lateness.last, now)) {
      lateness.since = excess.onset;
      lateness.after.clear();
    }
    lateness.last = now;
    if (is_between) {
      lateness.after.insert(after);
    }
  }
}

bool BusyMachine::areUnrelated(const std::vector<std::size_t>& late,
                               const std::vector<bool>& silent, const Causes& causes) const {
  for (std::size_t cause = 0; cause < silent.size(); ++cause) {
    if (!silent[cause] && !std::binary_search(late.begin(), late.end(), cause)) {
      continue;
    }
    const std::vector<bool> downstream = causes.downstreamOf(cause);
    // Who comes late of itself, or after one that is downstream, too, is no victim.
    const auto isVictim = [&](std::size_t component) {
      const std::set<std::size_t>& after = lateness_[component].after;
      return component != cause && downstream[component] &&
             std::none_of(after.begin(), after.end(), [&](std::size_t other) {
               return other == component || other == cause || downstream[other];
             });
    };
    const auto victims =
        static_cast<std::size_t>(std::count_if(late.begin(), late.end(), isVictim));
    const bool is_late = !silent[cause];
    if (static_cast<double>(late.size() - victims + (is_late ? 0 : 1)) <
        model_->tuning().several) {
      return false;
    }
  }
  return true;
}

}  // namespace self_awareness::core::evidence
