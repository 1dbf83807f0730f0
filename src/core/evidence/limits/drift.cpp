#include "self_awareness/core/evidence/limits/drift.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace self_awareness::core::evidence {
namespace {

// The strategies: each pays by the probability p of such a rank or a higher one, exponent times
// p^(exponent - 1). The first one does not bet.
constexpr std::array<double, 3> kExponents = {1, 0.5, 0.25};
// Of what the better has, so much is divided anew before every sample: with less, a drift that
// begins after months is told later; with more, too much is lost until then.
constexpr double kGoesOver = 0.01;
constexpr double kEnough = 1e100;  // far beyond what is needed, and far from an overflow

/// What a strategy pays for a rank; 1 on average over all ranks.
/// @param rank from 1 (the largest) to samples
double payOf(double exponent, double rank, double samples) {
  return samples * (std::pow(rank / samples, exponent) - std::pow((rank - 1) / samples, exponent));
}

double sumOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

double medianOf(const std::vector<double>& sorted) {
  const std::size_t half = sorted.size() / 2;
  return sorted.empty()           ? 0
         : sorted.size() % 2 == 1 ? sorted[half]
                                  : (sorted[half - 1] + sorted[half]) / 2;
}

}  // namespace

Drift::Drift(std::size_t components)
    : bets_(components,
            Bets{{}, 0, std::vector<double>(kExponents.size(), 1.0 / kExponents.size()), 0}) {}

void Drift::check(const std::vector<double>& shares) const {
  if (shares.size() != bets_.size()) {
    throw std::invalid_argument("a sample has one share for each component");
  }
  if (!std::all_of(shares.begin(), shares.end(),
                   [](double share) { return std::isfinite(share) && share >= 0; })) {
    throw std::invalid_argument("a share is 0 or more, and finite");
  }
}

void Drift::add(const std::vector<double>& shares) {
  check(shares);
  ++samples_;
  for (std::size_t number = 0; number < shares.size(); ++number) {
    Bets& bets = bets_[number];
    bets.last = shares[number];
    const auto place = bets.shares.insert(
        std::lower_bound(bets.shares.begin(), bets.shares.end(), bets.last), bets.last);
    // Equal ones count as larger: that pays less than to draw lots.
    const auto rank = static_cast<double>(bets.shares.end() - place);
    const double before = sumOf(bets.stakes);
    const double all = std::min(before, kEnough);
    for (std::size_t k = 0; k < kExponents.size(); ++k) {
      bets.stakes[k] =
          all * ((1 - kGoesOver) * bets.stakes[k] / before + kGoesOver / kExponents.size());
      bets.stakes[k] *= payOf(kExponents[k], rank, static_cast<double>(samples_));
    }
    if (bets.told_by == 0 && sumOf(bets.stakes) >= needed()) {
      bets.told_by = samples_;
    }
  }
}

Drift::Component Drift::component(std::size_t number) const {
  const Bets& bets = bets_.at(number);
  return {sumOf(bets.stakes), medianOf(bets.shares), bets.last, bets.told_by};
}

}  // namespace self_awareness::core::evidence
