#include "core/verdict/name_list.h"

#include <algorithm>

namespace self_awareness::core {

std::string listed(const std::vector<std::string>& names, std::size_t most) {
  const std::size_t shown = std::min(names.size(), most);
  std::string words;
  for (std::size_t k = 0; k < shown; ++k) {
    words += (k == 0 ? "" : k + 1 == names.size() ? " and " : ", ") + names[k];
  }
  return shown == names.size() ? words
                               : words + " and " + std::to_string(names.size() - shown) + " more";
}

}  // namespace self_awareness::core
