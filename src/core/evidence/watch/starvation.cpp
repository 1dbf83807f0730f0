#include "core/evidence/watch/starvation.h"

#include <algorithm>

#include "self_awareness/core/evidence/count/statistics.h"
#include "self_awareness/core/stream/event.h"

namespace self_awareness::core::evidence {
namespace {

// Windows are judged a moment after they have ended, and what waited may come for as long as the
// starvation lasted.
constexpr std::int64_t kKept = 3 * kRateSpan;  // [ns]

}  // namespace

Starvation::Starvation(const Tuning& tuning)
    : starved_(tuning.starved),
      usual_time_(tuning.usual_load_time * 1e9),
      unknown_time_(std::min(tuning.accept_after * 1e9, usual_time_)) {
  restart();
}

void Starvation::restart() {
  usual_ = 0;
  known_for_ = unknown_time_;
  starved_in_.clear();
}

void Starvation::add(const Waiting& waiting) {
  const auto length = static_cast<double>(waiting.to - waiting.from);
  if (length <= 0) {
    return;
  }
  const double share = std::min(static_cast<double>(waiting.waited) / length, 1.0);
  known_for_ = std::min(known_for_ + length, usual_time_);
  usual_ += (share - usual_) * std::min(length / known_for_, 1.0);
  while (!starved_in_.empty() && starved_in_.front().to < waiting.to - kKept) {
    starved_in_.pop_front();
  }
  if (share - usual_ >= starved_) {
    starved_in_.push_back(waiting);
  }
}

bool Starvation::holdsBack(std::int64_t stamp) const {
  auto last = std::find_if(starved_in_.rbegin(), starved_in_.rend(),
                           [&](const Waiting& waiting) { return waiting.to <= stamp; });
  if (last == starved_in_.rend()) {
    return false;
  }
  // What waited comes for as long as it waited.
  const std::int64_t until = last->to;
  std::int64_t since = last->from;
  for (++last; last != starved_in_.rend() && last->to == since; ++last) {
    since = last->from;
  }
  return stamp < until + std::min(until - since, kRateSpan);
}

std::int64_t Starvation::waitedIn(std::int64_t from, std::int64_t end) const {
  from = std::max(from, end - kRateSpan);
  std::int64_t waited = 0;
  for (const Waiting& waiting : starved_in_) {
    if (waiting.to <= end && waiting.to > from) {
      waited += std::min(waiting.waited, waiting.to - from);
    }
  }
  return waited;
}

}  // namespace self_awareness::core::evidence
