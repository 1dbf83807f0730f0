#include "core/evidence/channel/share.h"

#include <cmath>

namespace self_awareness::core::evidence {

double likelyShare(double seen, double all, double deviations) {
  const double share = seen / all;
  const double spread = deviations * deviations / all;
  return (share + spread / 2 +
          deviations * std::sqrt(share * (1 - share) / all + spread / (4 * all))) /
         (1 + spread);
}

}  // namespace self_awareness::core::evidence
