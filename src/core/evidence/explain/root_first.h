#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace self_awareness::core::evidence {

/// Orders what is said of components so that roots come before their victims (docs/method.md,
/// section 6). Upstream before downstream is no total order: who has the fewest others upstream is
/// next.
/// @param components numbers of those that it is said of, the likeliest first; they break ties
/// @param is_upstream whether what is wrong with the second component comes from the first
/// @return indexes into `components`, roots first
std::vector<std::size_t> rootFirst(
    const std::vector<std::size_t>& components,
    const std::function<bool(std::size_t, std::size_t)>& is_upstream);

}  // namespace self_awareness::core::evidence
