#include "self_awareness/core/evidence/count/delay_histogram.h"

#include <algorithm>
#include <cmath>

#include "core/evidence/count/bin_arrays.h"
#include "core/evidence/count/log_bins.h"

namespace self_awareness::core::evidence {
namespace {

template <typename Counts>
ByBin probabilitiesOf(const Counts& counts) {
  const double total = kPriorCount * static_cast<double>(counts.size()) +
                       asArray(counts).template cast<double>().sum();
  ByBin found{};
  std::transform(counts.begin(), counts.end(), found.begin(), [total](std::uint64_t count) {
    return (static_cast<double>(count) + kPriorCount) / total;
  });
  return found;
}

ByBin logsOf(ByBin found) {
  std::transform(found.begin(), found.end(), found.begin(),
                 [](double each) { return std::log(each); });
  return found;
}

}  // namespace

std::uint64_t DelayHistogram::total() const {
  return asArray(*this).cast<std::uint64_t>().sum();
}

DelayHistogram::Bins DelayHistogram::middle(double share) const {
  const auto all = static_cast<double>(total());
  Bins bins;
  double below = 0;
  for (std::size_t bin = 0; bin < size(); ++bin) {
    bins.first = below <= (1 - share) / 2 * all ? bin : bins.first;
    bins.last = below < (1 + share) / 2 * all ? bin : bins.last;
    below += (*this)[bin];
  }
  return bins;
}

double DelayHistogram::quantile(double share, double longest) const {
  const double wanted = share * static_cast<double>(total());
  double below = 0;
  for (std::size_t bin = 0; bin < size(); ++bin) {
    const double count = (*this)[bin];
    if (count > 0 && below + count >= wanted) {
      const auto lower = static_cast<double>(log_bins::lowerEdge(bin));
      const double upper =
          bin + 1 < size() ? static_cast<double>(log_bins::lowerEdge(bin + 1)) : longest;
      const double width = std::min(upper, std::max(longest, lower)) - lower;
      return lower + width * (wanted - below) / count;
    }
    below += count;
  }
  return 0;
}

ByBin DelayHistogram::probabilities() const {
  return probabilitiesOf(*this);
}

ByBin logProbabilities(const DelayHistogram& counts) {
  return logsOf(counts.probabilities());
}

ByBin logProbabilities(const SumOfDelays& counts) {
  return logsOf(probabilitiesOf(counts));
}

}  // namespace self_awareness::core::evidence
