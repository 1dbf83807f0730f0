#include "core/evidence/blame/busy_machine.h"

#include <algorithm>
#include <utility>

#include "core/evidence/channel/channel.h"

namespace self_awareness::core::evidence {
namespace {

// Share of the last kRateSpan. Processes that wait for less are forgiven, and not spoken of: that
// comes and goes wherever more is begun at once than there are processors.
constexpr double kNearlyAll = 0.9;

}  // namespace

BusyMachine::BusyMachine(std::shared_ptr<const Model> model)
    : model_(std::move(model)), followers_(model_) {}

std::optional<Busy> BusyMachine::closeWindow(const std::vector<double>& shares,
                                             const Scorer& scorer, bool abnormal) {
  std::optional<Busy> busy = late(shares, scorer, abnormal);
  if (const double seconds = starved(scorer.heard()); seconds > 0) {
    busy = busy.value_or(Busy{});
    busy->starved = seconds;
  }
  return busy;
}

double BusyMachine::starved(const Heard& heard) {
  const std::int64_t waited = heard.starved();
  if (static_cast<double>(waited) < kNearlyAll * static_cast<double>(kRateSpan)) {
    starved_since_.reset();
    return 0;
  }
  starved_since_ = starved_since_.value_or(heard.windowEnd() - waited);
  return toSeconds(heard.windowEnd() - *starved_since_);
}

std::optional<Busy> BusyMachine::late(const std::vector<double>& shares, const Scorer& scorer,
                                      bool abnormal) {
  if (!abnormal && !busy_) {
    return std::nullopt;
  }
  const Tuning& tuning = model_->tuning();
  const std::vector<std::string>& names = model_->components();
  std::vector<bool> heard(names.size(), false);
  std::vector<bool> silent(names.size(), false);
  std::vector<double> largest(names.size(), 0);  // share of what is not silence
  for (std::size_t track = 0; track < shares.size(); ++track) {
    const EventId id = model_->tracks()[track].to;
    const std::size_t component = model_->componentIndex(id);
    heard[component] = heard[component] || scorer.heard().hasSeen(id);
    if (model_->finding(track) == Finding::kSilent) {
      silent[component] = silent[component] || shares[track] > 1;
    } else if (!model_->tracks()[track]
                    .channel->hasShareOfItsOwn()) {  // these say nothing of late
      largest[component] = std::max(largest[component], shares[track]);
    }
  }
  const Followers::Leads leads = followers_.leads(shares);
  const auto isLate = [&](std::size_t component) {
    return !silent[component] &&
           largest[component] > (busy_ ? tuning.still_busy_share : tuning.near_limit);
  };
  // Who follows as usual one that is late or silent is only its victim.
  std::vector<bool> led(names.size(), false);
  for (std::size_t follower = 0; follower < names.size() && !busy_; ++follower) {
    for (std::size_t leader = 0; leader < names.size() && isLate(follower); ++leader) {
      led[follower] = led[follower] ||
                      ((isLate(leader) || silent[leader]) && leads.count({leader, follower}) > 0);
    }
  }
  Busy busy;
  std::size_t roots = 0;
  std::size_t silences = 0;
  for (std::size_t component = 0; component < names.size(); ++component) {
    busy.components += heard[component] ? 1 : 0;
    busy.late += isLate(component) ? 1 : 0;
    roots += isLate(component) && !led[component] ? 1 : 0;
    silences += silent[component] ? 1 : 0;
  }
  // Silences of a busy machine end soon. Where many last, something else is wrong.
  busy_ = static_cast<double>(roots) >= tuning.fewest_busy &&
          static_cast<double>(busy.late) * tuning.busy_one_in >=
              static_cast<double>(busy.components) &&
          busy.late >= silences;
  return busy_ ? std::optional<Busy>(busy) : std::nullopt;
}

}  // namespace self_awareness::core::evidence
