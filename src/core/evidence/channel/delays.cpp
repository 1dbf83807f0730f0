#include "core/evidence/channel/delays.h"

#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "core/evidence/count/bin_arrays.h"
#include "self_awareness/core/evidence/channel/model.h"

namespace self_awareness::core::evidence {
namespace {

// Fewer delays do not say what is usual.
constexpr std::size_t kFewestBefore = 10;
// If fewer of the unusual delays lie on one side of the usual one, they are scattered around it.
constexpr double kOneSided = 0.8;

/// Mean and standard deviation of -log P of a pair's delays, learned from one half of the training
/// and measured on the other, both ways.
class HeldOutSurprise {
 public:
  explicit HeldOutSurprise(double least_deviation) : least_deviation_(least_deviation) {}

  void add(const DelayHistogram& learned, const DelayHistogram& measured) {
    if (learned.total() == 0) {
      return;
    }
    const LogProbabilities log_probabilities = learned.logProbabilities();
    const auto logs = asArray(log_probabilities);
    const auto counts = asArray(measured).cast<double>();
    count_ += counts.sum();
    sum_ -= (counts * logs).sum();
    squares_ += (counts * logs.square()).sum();
  }
  double mean() const { return count_ > 0 ? sum_ / count_ : 0; }
  double deviation() const {
    const double variance = count_ > 0 ? squares_ / count_ - mean() * mean() : 0;
    return std::max(std::sqrt(std::max(variance, 0.0)), least_deviation_);
  }

 private:
  double least_deviation_;  // delays that all fall into one bin vary by nothing
  double count_ = 0;
  double sum_ = 0;
  double squares_ = 0;
};

double lowerEdge(std::size_t bin) {
  return static_cast<double>(log_bins::lowerEdge(bin));
}

double upperEdge(std::size_t bin) {
  return bin + 1 < log_bins::kBins ? lowerEdge(bin + 1) : std::numeric_limits<double>::infinity();
}

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

// A small time in the unit that shows it.
std::string inWords(double seconds) {
  char text[40];
  if (seconds < 1) {
    std::snprintf(text, sizeof text, seconds < 0.1 ? "%.1f ms" : "%.0f ms", 1000 * seconds);
  } else {
    std::snprintf(text, sizeof text, "%.2f s", seconds);
  }
  return text;
}

/// @param scatter of the unusual ones; none: nearly all of them are on one side of the usual one
std::string inWords(const Reason& reason, std::optional<double> scatter) {
  const std::string after = " after " + reason.after;
  if (reason.times == 0) {
    return "at unusual delays" + after;
  }
  const double later = reason.value - reason.usual;
  char times[60];
  std::snprintf(times, sizeof times, " than usual %zu time%s of %zu", reason.times,
                reason.times == 1 ? "" : "s", reason.of);
  char usual[80];
  std::snprintf(usual, sizeof usual, " in the last %.1f s, usually %.3f s", reason.lasted,
                reason.usual);
  return inWords(scatter ? *scatter : std::abs(later)) +
         (scatter     ? " earlier or later"
          : later > 0 ? " later"
                      : " earlier") +
         times + after + usual;
}

Kind kindOf(const Reason& reason, bool scattered) {
  if (reason.times == 0 || scattered || reason.value == reason.usual) {
    return Kind::kOutOfOrder;
  }
  const bool later = reason.value > reason.usual;
  return later ? Kind::kLate : Kind::kEarly;
}

}  // namespace

DelaySurprise::DelaySurprise(const Model& model, const Halves& halves, EventId from, EventId to) {
  const Tuning& tuning = model.tuning();
  HeldOutSurprise usual(tuning.least_deviation);
  usual.add(halves[0].delays(from, to), halves[1].delays(from, to));
  usual.add(halves[1].delays(from, to), halves[0].delays(from, to));
  const LogProbabilities logs = model.learned().delays(from, to).logProbabilities();
  std::transform(logs.begin(), logs.end(), by_bin_.begin(), [&](double log) {
    return std::min((-log - usual.mean()) / usual.deviation(), tuning.most_surprise);
  });
  learnHarmless(model, from, to);
  for (std::size_t bin = 0; bin < by_bin_.size(); ++bin) {
    if (isHarmlessBin(bin)) {
      by_bin_[bin] = std::min(by_bin_[bin], 0.0);
    }
  }
}

void DelaySurprise::learnHarmless(const Model& model, EventId from, EventId to) {
  const Tuning& tuning = model.tuning();
  const double period = model.learned().type(from).meanGap();
  const double effect = tuning.leastEffectOnDelay(period);
  period_ = period;
  const DelayHistogram::Bins usual = model.learned().delays(from, to).middle(tuning.usual);
  shortest_ = lowerEdge(usual.first) - effect;
  longest_ = upperEdge(usual.last) + effect;
}

bool DelaySurprise::isHarmlessBin(std::size_t bin) const {
  const auto lies = [&](double shift) {
    return lowerEdge(bin) + shift >= shortest_ && upperEdge(bin) + shift <= longest_;
  };
  // The bin that a period lies in is wide.
  const bool ends_period = lowerEdge(bin) < period_ && period_ <= upperEdge(bin);
  return lies(0) ||
         (period_ > 0 && (lies(period_) || lies(-period_) || (ends_period && shortest_ <= 0)));
}

ExpectedDelays::ExpectedDelays(const Model& model, const Halves& halves,
                               std::vector<std::size_t> tracks)
    : Expectation(std::move(tracks)), model_(model) {
  for (const std::size_t track : this->tracks()) {
    surprises_.emplace_back(model, halves, model.tracks()[track].from, model.tracks()[track].to);
  }
}

double ExpectedDelays::leastLimit(std::size_t /*track*/) const {
  // One late event makes two unusual delays, one too long and one too short: they must not be
  // enough.
  return 2 * model_.tuning().most_surprise + 1;
}

double ExpectedDelays::limit(std::size_t /*track*/, double largest, double most) const {
  return limitOfSum(largest, most);
}

const Track& ExpectedDelays::track(std::size_t number) const {
  return model_.tracks()[tracks()[number]];
}

void describeDelays(const std::vector<SeenDelay>& seen, double cap, double usual, std::int64_t now,
                    Reason& reason) {
  reason.unit = unit::kSeconds;
  std::optional<double> scatter;
  if (!seen.empty()) {
    const auto first = sinceZero(seen, cap);
    const std::vector<double> before = lengths(seen.begin(), first, false);
    const std::vector<double> unusual = lengths(first, seen.end(), true);
    usual = before.size() < kFewestBefore ? usual : median(before);
    scatter = scatterOf(unusual, usual);
    reason.value = 1e-9 * median(unusual.empty() ? lengths(first, seen.end(), false) : unusual);
    reason.usual = 1e-9 * usual;
    reason.times = unusual.size();
    reason.of = static_cast<std::size_t>(seen.end() - first);
    reason.lasted = toSeconds(now - first->stamp);
  }
  reason.kind = kindOf(reason, scatter.has_value());
  reason.words = inWords(reason, scatter ? std::optional(1e-9 * *scatter) : std::nullopt);
}

}  // namespace self_awareness::core::evidence
