#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace self_awareness::core::evidence {

/// Orders things so that roots come before their victims (docs/method.md, section 6.2). Root
/// before victim is no total order: what has the fewest roots among the remaining ones is next.
/// @param number of them, the likeliest first: they break ties
/// @param is_root whether what is wrong with the second of two comes from the first
/// @return their places, roots first
std::vector<std::size_t> rootFirst(std::size_t number,
                                   const std::function<bool(std::size_t, std::size_t)>& is_root);

}  // namespace self_awareness::core::evidence
