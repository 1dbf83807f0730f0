#include "core/evidence/channel/share.h"

#include <cmath>

namespace self_awareness::core::evidence {

double likelyShare(double seen, double all) {
  const double share = seen / all;
  const double one = 1 / all;
  return (share + one / 2 + std::sqrt((share * (1 - share) + one / 4) * one)) / (1 + one);
}

}  // namespace self_awareness::core::evidence
