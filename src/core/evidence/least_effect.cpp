#include "self_awareness/core/evidence/least_effect.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace self_awareness::core::evidence {
namespace {

// Both ends of a gap move, and that a period changes is also seen by overdue and rate. The ratios
// are fixed: who wants to hear of less, or of more, wants it of gaps, too.
constexpr double kGapsToDelays = 2;           // in time
constexpr double kGapsToDelaysOfPeriod = 10;  // in shares of the period

}  // namespace

void LeastEffect::validate() const {
  std::ostringstream problem;
  if (!std::isfinite(time) || time < 0) {
    problem << "the least effect must be a finite time of 0 ms or more, not " << time * 1e-6
            << " ms";
  } else if (!(of_period >= 0 && of_period < 1)) {
    problem << "the least effect must be a share of the period from 0 to below 1, not "
            << of_period;
  } else {
    return;
  }
  throw std::invalid_argument(problem.str());
}

double LeastEffect::onDelay(double period) const {
  return std::max(time, of_period * period);
}

double LeastEffect::onGap(double period) const {
  return std::max(kGapsToDelays * time, kGapsToDelaysOfPeriod * of_period * period);
}

}  // namespace self_awareness::core::evidence
