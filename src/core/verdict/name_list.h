#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace self_awareness::core {

/// Names as people list them: "a", "a and b", "a, b and c", or "a, b and 4 more".
/// @param most of them that are written
std::string listed(const std::vector<std::string>& names, std::size_t most);

}  // namespace self_awareness::core
