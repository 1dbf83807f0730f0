#pragma once

namespace self_awareness::core::evidence {

/// The largest share that is likely, by one standard deviation (Wilson, "Probable inference",
/// 1927).
/// @param seen of `all`; may be no whole number
/// @param all more than 0
double likelyShare(double seen, double all);

}  // namespace self_awareness::core::evidence
