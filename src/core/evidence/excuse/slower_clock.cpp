#include "core/evidence/excuse/slower_clock.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>

#include "core/evidence/channel/channel.h"
#include "self_awareness/core/stream/clock.h"

namespace self_awareness::core::evidence {
namespace {

// A pace is known to a fourth after a few messages: the first gap began with the old one.
constexpr double kSameFactor = 1.25;
// For so long after two were faster, one is so for the same reason [ns].
constexpr std::int64_t kHold = 20 * kNanosecondsPerSecond;

double factorOf(const Suspect& suspect) {
  return suspect.reason.value / suspect.reason.usual;
}

}  // namespace

SlowerClock::SlowerClock(std::shared_ptr<const Model> model, const Explanation& explanation)
    : model_(std::move(model)), explanation_(explanation) {}

void SlowerClock::excuse(std::vector<Excess>& excesses, const Scorer& scorer,
                         const RecentEvents& events) {
  suspects_.clear();
  if (!isSimulated(scorer.heard().start())) {
    return;
  }
  const ByComponent faster = this->faster(excesses, scorer, events);
  const std::int64_t now = scorer.heard().windowEnd();
  if (haveNoOtherReason(faster, excesses, scorer.heard())) {
    if (faster.size() > number_) {
      number_ = faster.size();
      reason_ = sendsFaster(number_, factorOf(faster.begin()->second));
    }
    last_ = now;
  }
  // When it is over, the sum of one falls sooner than that of another one.
  if (!last_ || now - *last_ > kHold) {
    restart();
    return;
  }
  for (const auto& [component, suspect] : faster) {
    suspects_.push_back(suspect);
    suspects_.back().reason = reason_;
  }
  for (Excess& excess : excesses) {
    const Track& track = model_->tracks()[excess.track];
    const bool is_of_them =
        faster.count(excess.component) > 0 || faster.count(model_->componentIndex(track.from)) > 0;
    if (excess.excuse == Excuse::kNone && is_of_them && !track.channel->hasShareOfItsOwn() &&
        !isAbsence(track.channel->finding())) {
      excess.excuse = Excuse::kSlowerClock;
    }
  }
}

SlowerClock::ByComponent SlowerClock::faster(const std::vector<Excess>& excesses,
                                             const Scorer& scorer,
                                             const RecentEvents& events) const {
  ByComponent faster;
  std::vector<double> factors;
  for (const Excess& excess : excesses) {
    const Track& track = model_->tracks()[excess.track];
    // Who does not come any more has kept its sum.
    const bool comes = scorer.heard().silence(track.to) <= model_->longestGap(track.to);
    if (excess.excuse == Excuse::kNone && track.channel->kind() == Kind::kFast && comes &&
        excess.share > model_->tuning().near_limit && faster.count(excess.component) == 0) {
      Suspect suspect;
      suspect.id = track.to;
      suspect.component = model_->components()[excess.component];
      suspect.onset = excess.onset;
      scorer.explain(excess.track, events, suspect);
      if (suspect.reason.unit != unit::kHertz) {
        continue;
      }
      factors.push_back(factorOf(suspect));
      faster.emplace(excess.component, std::move(suspect));
    }
  }
  std::sort(factors.begin(), factors.end());
  for (auto each = faster.begin(); each != faster.end();) {
    const double ratio = factorOf(each->second) / factors[factors.size() / 2];
    each = std::max(ratio, 1 / ratio) < kSameFactor ? std::next(each) : faster.erase(each);
  }
  return faster;
}

bool SlowerClock::haveNoOtherReason(const ByComponent& faster, const std::vector<Excess>& excesses,
                                    const Heard& heard) const {
  if (faster.size() < 2) {
    return false;
  }
  const bool is_abnormal =
      std::any_of(excesses.begin(), excesses.end(), [&](const Excess& excess) {
        return excess.share > 1 && faster.count(excess.component) > 0 &&
               model_->tracks()[excess.track].channel->kind() == Kind::kFast;
      });
  bool others = false;
  for (EventId id = 0; id < model_->size(); ++id) {
    others = others || (heard.hasSeen(id) && faster.count(model_->componentIndex(id)) == 0);
  }
  if (!is_abnormal || !others) {
    return false;
  }
  const Explanation::Leads leads = explanation_.leads(excesses);
  const auto isRootOfAll = [&](const auto& root) {
    const std::vector<bool> downstream = explanation_.downstreamOf(root.first, leads);
    return std::all_of(faster.begin(), faster.end(), [&](const auto& each) {
      return each.first == root.first || downstream[each.first];
    });
  };
  return std::none_of(faster.begin(), faster.end(), isRootOfAll);
}

}  // namespace self_awareness::core::evidence
