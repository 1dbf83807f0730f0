#include "core/evidence/excuse/slower_clock.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include "core/evidence/channel/channel.h"
#include "self_awareness/core/stream/clock.h"

namespace self_awareness::core::evidence {
namespace {

// For so long after two were faster, one is so for the same reason [ns].
constexpr std::int64_t kHold = 2 * kOneCause;

double factorOf(const Suspect& suspect) {
  return suspect.reason.value / suspect.reason.usual;
}

}  // namespace

std::optional<std::int64_t> SlowerClock::closeWindow(const Unusual& window, Judgement& judgement) {
  faster_.clear();
  if (!isSimulated(window.heard().start())) {
    return std::nullopt;
  }
  faster_ = faster(window);
  const std::int64_t now = window.heard().windowEnd();
  if (haveNoOtherReason(faster_, window)) {
    since_ = since_.value_or(now);
    if (faster_.size() > number_) {
      number_ = faster_.size();
      reason_ = sendsFaster(number_, factorOf(faster_.begin()->second));
    }
    last_ = now;
  }
  // When it is over, the sum of one falls sooner than that of another one.
  if (!since_ || now - last_ > kHold) {
    restart();
    return std::nullopt;
  }
  for (const Excess& excess : window.excesses) {
    const bool is_of_them =
        faster_.count(excess.component) > 0 && excess.channel->kind() == Kind::kFast;
    since_ = is_of_them ? std::min(*since_, excess.onset) : since_;
  }
  for (const auto& [component, suspect] : faster_) {
    judgement.suspects.push_back(suspect);
    judgement.suspects.back().reason = reason_;
  }
  return *since_ - kOneCause;
}

bool SlowerClock::explains(const Excess& excess, const Unusual& /*window*/) const {
  const bool is_of_them = faster_.count(excess.component) > 0 ||
                          faster_.count(model_->componentIndex(excess.from)) > 0;
  return is_of_them && excess.channel->mayBeLate() && !excess.isAbsence();
}

void SlowerClock::restart() {
  faster_.clear();
  since_.reset();
  number_ = 0;
}

SlowerClock::ByComponent SlowerClock::faster(const Unusual& window) const {
  ByComponent faster;
  std::vector<double> factors;
  for (const Excess& excess : window.excesses) {
    // Who does not come any more has kept its sum.
    const bool comes = window.heard().silence(excess.id) <= model_->longestGap(excess.id);
    if (excess.channel->kind() == Kind::kFast && comes &&
        excess.share > model_->tuning().near_limit && faster.count(excess.component) == 0) {
      Suspect suspect;
      suspect.id = excess.id;
      suspect.component = model_->components()[excess.component];
      suspect.onset = excess.onset;
      window.scorer.explain(excess.track, window.events, suspect);
      if (suspect.reason.unit != unit::kHertz) {
        continue;
      }
      factors.push_back(factorOf(suspect));
      faster.emplace(excess.component, std::move(suspect));
    }
  }
  std::sort(factors.begin(), factors.end());
  // A pace is known to a fourth after a few messages: the first gap began with the old one.
  const double same = model_->tuning().margin_of_silence;
  for (auto each = faster.begin(); each != faster.end();) {
    const double ratio = factorOf(each->second) / factors[factors.size() / 2];
    each = std::max(ratio, 1 / ratio) < same ? std::next(each) : faster.erase(each);
  }
  return faster;
}

bool SlowerClock::haveNoOtherReason(const ByComponent& faster, const Unusual& window) const {
  if (faster.size() < 2) {
    return false;
  }
  const bool is_abnormal =
      std::any_of(window.excesses.begin(), window.excesses.end(), [&](const Excess& excess) {
        return excess.share > 1 && faster.count(excess.component) > 0 &&
               excess.channel->kind() == Kind::kFast;
      });
  bool others = false;
  for (EventId id = 0; id < model_->size(); ++id) {
    others =
        others || (window.heard().hasSeen(id) && faster.count(model_->componentIndex(id)) == 0);
  }
  const auto isRootOfAll = [&](const auto& root) {
    const std::vector<bool> downstream = window.causes.downstreamOf(root.first);
    return std::all_of(faster.begin(), faster.end(), [&](const auto& each) {
      return each.first == root.first || downstream[each.first];
    });
  };
  return is_abnormal && others && std::none_of(faster.begin(), faster.end(), isRootOfAll);
}

}  // namespace self_awareness::core::evidence
