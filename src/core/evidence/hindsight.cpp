#include "core/evidence/hindsight.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/evidence/log_bins.h"
#include "core/evidence/scorer.h"

namespace self_awareness::core::evidence {
namespace {

// Fewer delays do not say what is usual.
constexpr std::size_t kFewestBefore = 10;
// If fewer of the unusual delays lie on one side of the usual one, they are scattered around it.
constexpr double kOneSided = 0.8;

struct SeenDelay {
  std::int64_t stamp = 0;  // of the later event [ns]
  double delay = 0;        // [ns]
  double step = 0;         // added to the sum
};
using SeenDelays = std::vector<SeenDelay>;

/// @param values at least one
double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The first delay since the sum was 0 last; the last delay if it is 0 now.
/// @param delays at least one
SeenDelays::const_iterator sinceZero(const SeenDelays& delays, double cap) {
  auto first = delays.begin();
  double sum = 0;
  for (auto each = delays.begin(); each != delays.end(); ++each) {
    if (sum == 0) {
      first = each;
    }
    sum = std::clamp(sum + each->step, 0.0, cap);
  }
  return sum > 0 ? first : std::prev(delays.end());
}

std::vector<double> lengths(SeenDelays::const_iterator begin, SeenDelays::const_iterator end,
                            bool unusual_only) {
  std::vector<double> lengths;
  for (; begin != end; ++begin) {
    if (begin->step > 0 || !unusual_only) {
      lengths.push_back(begin->delay);
    }
  }
  return lengths;
}

/// How far the delays are from the usual one, if they lie on both sides of it.
std::optional<double> scatterOf(std::vector<double> delays, double usual) {
  const auto number = static_cast<double>(delays.size());
  const auto longer = static_cast<double>(std::count_if(
      delays.begin(), delays.end(), [usual](double delay) { return delay > usual; }));
  if (std::max(longer, number - longer) >= kOneSided * number) {
    return std::nullopt;
  }
  for (double& delay : delays) {
    delay = std::abs(delay - usual);
  }
  return median(std::move(delays));
}

}  // namespace

Hindsight::Hindsight(std::shared_ptr<const Model> model)
    : model_(std::move(model)), events_(kMostEvents), last_(model_->size(), 0) {}

void Hindsight::add(const Event& event) {
  if (!model_->knows(event.id)) {
    return;
  }
  ++number_;
  std::uint64_t& last = last_[event.id];
  const std::uint64_t before = isRemembered(last) ? number_ - last : 0;
  events_[number_ % kMostEvents] = {event.stamp, event.id, static_cast<std::uint32_t>(before)};
  last = number_;
}

void Hindsight::restart() {
  number_ = 0;
  std::fill(last_.begin(), last_.end(), 0);
}

std::uint64_t Hindsight::before(std::uint64_t number) const {
  const std::uint32_t distance = events_[number % kMostEvents].before;
  return distance > 0 && isRemembered(number - distance) ? number - distance : 0;
}

std::vector<Event> Hindsight::eventsOf(EventId a, EventId b) const {
  std::vector<Event> events;
  std::uint64_t of_a = isRemembered(last_[a]) ? last_[a] : 0;
  std::uint64_t of_b = a != b && isRemembered(last_[b]) ? last_[b] : 0;
  while (of_a > 0 || of_b > 0) {
    std::uint64_t& next = of_a > of_b ? of_a : of_b;
    const Remembered& event = events_[next % kMostEvents];
    events.push_back({event.stamp, event.id});
    next = before(next);
  }
  std::reverse(events.begin(), events.end());
  return events;
}

std::optional<Hindsight::Delays> Hindsight::delays(std::size_t track, double cap) const {
  const EventId to = model_->tracks().at(track).to;
  const EventId from = model_->tracks().at(track).from;
  SeenDelays seen;
  std::optional<std::int64_t> since;  // stamp of the last `from`, until a `to` comes after it
  std::optional<std::int64_t> last;   // stamp of the last `to`
  double regime = 0;
  const double drift = model_->tuning().drift;
  const std::int64_t regime_time = toNanoseconds(model_->tuning().regime);
  for (const Event& event : eventsOf(from, to)) {
    if (event.id == to && since) {
      const std::int64_t delay = std::max<std::int64_t>(event.stamp - *since, 0);
      const double surprise = model_->surprise(track, delay);
      seen.push_back(
          {event.stamp, static_cast<double>(delay), surprise - std::max(regime, 0.0) - drift});
      regime += (surprise - regime) * shareOf(regime_time, last ? event.stamp - *last : 0);
      since.reset();
    }
    if (event.id == to) {
      last = event.stamp;
    }
    if (event.id == from) {
      since = event.stamp;
    }
  }
  if (seen.empty()) {
    return std::nullopt;
  }
  const auto first = sinceZero(seen, cap);
  const std::vector<double> before = lengths(seen.begin(), first, false);
  const std::vector<double> unusual = lengths(first, seen.end(), true);
  Delays found;
  found.since = first->stamp;
  found.number = static_cast<std::size_t>(seen.end() - first);
  found.unusual = unusual.size();
  found.delay = median(unusual.empty() ? lengths(first, seen.end(), false) : unusual);
  found.usual =
      before.size() < kFewestBefore ? model_->usualDelay(from, to, 0.5) * 1e9 : median(before);
  found.scatter = scatterOf(unusual, found.usual);
  return found;
}

std::optional<Hindsight::Answers> Hindsight::answers(std::size_t track, double cap) const {
  const EventId to = model_->tracks().at(track).to;
  const EventId from = model_->tracks().at(track).from;
  Answers found;
  double sum = 0;
  std::optional<std::int64_t> asked;  // stamp of the last question
  std::size_t came = 0;               // answers since then
  std::size_t owed = 0;               // answers that may still come back
  for (const Event& event : eventsOf(from, to)) {
    if (event.id == to) {
      ++came;
      continue;
    }
    if (asked && event.stamp - *asked < model_->usualAnswer(track)) {
      continue;  // a burst is one question
    }
    if (asked) {
      if (sum == 0) {
        found = {*asked, 0, 0};
      }
      const std::size_t late = came > 0 ? std::min(came - 1, owed) : 0;
      owed = came > 0 ? owed - late : owed + 1;
      ++found.asked;
      found.missed = came > 0 ? found.missed - std::min(found.missed, late) : found.missed + 1;
      const double step =
          came > 0 ? model_->answered(track) - static_cast<double>(late) * model_->missed(track)
                   : model_->missed(track);
      sum = std::clamp(sum + step, 0.0, cap);
    }
    asked = event.stamp;
    came = 0;
  }
  return sum > 0 ? std::optional<Answers>(found) : std::nullopt;
}

}  // namespace self_awareness::core::evidence
