#include "core/evidence/blame/busy_machine.h"

#include <algorithm>
#include <utility>

#include "core/evidence/channel/channel.h"

namespace self_awareness::core::evidence {
namespace {

// Share of the last kRateSpan. Processes that wait for less are forgiven, and not spoken of: that
// comes and goes wherever more is begun at once than there are processors.
constexpr double kNearlyAll = 0.9;

// A load that grows makes one after the other late. Who was late longer ago had another reason.
constexpr std::int64_t kOnset = 5 * kRateSpan;  // [ns]

/// Whether what a track says is that its type came late, or too seldom: who has no time does not
/// send too often.
bool isOfLate(std::size_t track, const Scorer& scorer, const RecentEvents& events) {
  const Track& watched = scorer.model().tracks()[track];
  if (watched.channel->hasShareOfItsOwn()) {
    return false;
  }
  const Kind kind = suspectOf(track, scorer, events).reason.kind;
  return kind != Kind::kFast && kind != Kind::kEarly;
}

}  // namespace

BusyMachine::BusyMachine(std::shared_ptr<const Model> model)
    : model_(std::move(model)),
      followers_(model_),
      late_since_(model_->components().size(), kNever),
      silent_at_(model_->components().size(), 0) {}

void BusyMachine::restart() {
  busy_ = false;
  std::fill(late_since_.begin(), late_since_.end(), kNever);
  std::fill(silent_at_.begin(), silent_at_.end(), 0);
  starved_since_.reset();
}

std::optional<Busy> BusyMachine::closeWindow(const std::vector<double>& shares,
                                             const Scorer& scorer, const RecentEvents& events,
                                             bool abnormal) {
  std::optional<Busy> busy = late(shares, scorer, events, abnormal);
  if (const auto since = starvedSince(scorer.heard())) {
    busy = busy.value_or(Busy{0, 0, 0, *since - kOnset});
    busy->starved = toSeconds(scorer.heard().windowEnd() - *since);
  }
  return busy;
}

std::optional<std::int64_t> BusyMachine::starvedSince(const Heard& heard) {
  const std::int64_t waited = heard.starved();
  if (static_cast<double>(waited) < kNearlyAll * static_cast<double>(kRateSpan)) {
    starved_since_.reset();
  } else {
    starved_since_ = starved_since_.value_or(heard.windowEnd() - waited);
  }
  return starved_since_;
}

std::optional<Busy> BusyMachine::late(const std::vector<double>& shares, const Scorer& scorer,
                                      const RecentEvents& events, bool abnormal) {
  if (!abnormal && !busy_) {
    std::fill(late_since_.begin(), late_since_.end(), kNever);
    return std::nullopt;
  }
  const Tuning& tuning = model_->tuning();
  const std::vector<std::string>& names = model_->components();
  std::vector<bool> heard(names.size(), false);
  std::vector<bool> silent(names.size(), false);
  const double enough = busy_ ? tuning.still_busy_share : tuning.near_limit;
  std::vector<bool> late(names.size(), false);
  const std::int64_t now = scorer.heard().windowEnd();
  // What looks back to a silence says what that was, and nothing of who is back.
  const auto isBack = [&](std::size_t track, std::size_t component) {
    return silent_at_[component] > now - model_->tracks()[track].channel->looksBack();
  };
  for (std::size_t track = 0; track < shares.size(); ++track) {
    const EventId id = model_->tracks()[track].to;
    const std::size_t component = model_->componentIndex(id);
    heard[component] = heard[component] || scorer.heard().hasSeen(id);
    if (model_->finding(track) == Finding::kSilent) {
      silent[component] = silent[component] || shares[track] > 1;
    } else if (!late[component] && shares[track] > enough && !isAbsence(model_->finding(track)) &&
               !isBack(track, component)) {
      late[component] = isOfLate(track, scorer, events);
    }
  }
  const Followers::Leads leads = followers_.leads(shares);
  const auto isLate = [&](std::size_t component) { return !silent[component] && late[component]; };
  // Who follows as usual one that is late or silent is only its victim.
  std::vector<bool> led(names.size(), false);
  for (std::size_t follower = 0; follower < names.size() && !busy_; ++follower) {
    for (std::size_t leader = 0; leader < names.size() && isLate(follower); ++leader) {
      led[follower] = led[follower] ||
                      ((isLate(leader) || silent[leader]) && leads.count({leader, follower}) > 0);
    }
  }
  Busy busy;
  std::vector<std::int64_t> since;
  std::size_t roots = 0;
  std::size_t silences = 0;
  for (std::size_t component = 0; component < names.size(); ++component) {
    busy.components += heard[component] ? 1 : 0;
    roots += isLate(component) && !led[component] ? 1 : 0;
    silences += silent[component] ? 1 : 0;
    silent_at_[component] = silent[component] ? now : silent_at_[component];
    std::int64_t& late = late_since_[component];
    late = isLate(component) ? std::min(late, now) : kNever;
    if (isLate(component)) {
      since.push_back(late);
    }
  }
  busy.late = since.size();
  // Silences of a busy machine end soon. Where many last, something else is wrong.
  const bool was_busy = busy_;
  busy_ = static_cast<double>(roots) >= tuning.fewest_busy &&
          static_cast<double>(busy.late) * tuning.busy_one_in >=
              static_cast<double>(busy.components) &&
          busy.late >= silences;
  if (!busy_) {
    return std::nullopt;
  }
  if (!was_busy) {
    const auto middle = since.begin() + static_cast<std::ptrdiff_t>(since.size() / 2);
    std::nth_element(since.begin(), middle, since.end());
    since_ = *middle - kOnset;
  }
  busy.since = since_;
  return busy;
}

}  // namespace self_awareness::core::evidence
