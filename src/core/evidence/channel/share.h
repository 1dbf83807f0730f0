#pragma once

namespace self_awareness::core::evidence {

/// The largest share that is likely (Wilson, "Probable inference", 1927).
/// @param seen of `all`; may be no whole number
/// @param all more than 0
/// @param deviations so many standard deviations are likely
double likelyShare(double seen, double all, double deviations);

}  // namespace self_awareness::core::evidence
