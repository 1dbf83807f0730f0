#include "core/evidence/channel/delays.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "core/evidence/channel/sum.h"
#include "self_awareness/core/evidence/channel/model.h"

namespace self_awareness::core::evidence {
namespace {

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

/// How far the delays are from the usual one, unless nearly all lie on one side of it.
std::optional<double> scatterOf(std::vector<double> delays, double usual, const Tuning& tuning) {
  const auto number = static_cast<double>(delays.size());
  const auto longer = static_cast<double>(std::count_if(
      delays.begin(), delays.end(), [usual](double delay) { return delay > usual; }));
  if (std::max(longer, number - longer) >= tuning.usual * number) {
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

DelaySteps::DelaySteps(const Model& model, EventId from, EventId to)
    : period_(model.learned().type(from).meanGap()) {
  const Tuning& tuning = model.tuning();
  const DelayHistogram delays = model.learned().delays(from, to);
  const DelayHistogram::Bins usual = delays.middle(tuning.usual);
  shortest_ = lowerEdge(usual.first) - 1e9 * tuning.least_effect;
  longest_ = upperEdge(usual.last) + 1e9 * tuning.least_effect;
  // Another delay is any that is possible before the next `from`, each bin as probable.
  const std::size_t last = std::max(usual.last, log_bins::bin(static_cast<std::int64_t>(period_)));
  const ByBin all = delays.probabilities();
  for (std::size_t bin = 0; bin < by_bin_.size(); ++bin) {
    const double other = bin <= last ? 1 / static_cast<double>(last + 1) : 0;
    by_bin_[bin] = stepOfSum(other / all[bin], tuning.least_sum);
    usual_ += by_bin_[bin] * delays[bin] / static_cast<double>(delays.total());
  }
  least_usual_ = tuning.usual * usual_;
}

void describeDelays(const std::vector<SeenDelay>& seen, double cap, double usual, std::int64_t now,
                    const Tuning& tuning, Reason& reason) {
  reason.unit = unit::kSeconds;
  std::optional<double> scatter;
  if (!seen.empty()) {
    const auto first = sinceZero(seen, cap);
    const std::vector<double> before = lengths(seen.begin(), first, false);
    const std::vector<double> unusual = lengths(first, seen.end(), true);
    const bool is_known = static_cast<double>(before.size()) >= tuning.fewest_gaps;
    usual = is_known ? median(before) : usual;
    scatter = scatterOf(unusual, usual, tuning);
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
