#include "self_awareness/core/stream/listed.h"

#include <cstddef>
#include <string_view>

namespace self_awareness::core {
namespace {

// No type field makes such a type: a field has no blank in its name.
constexpr std::string_view kBegin = "[lists ";
constexpr std::string_view kAfterField = ": ";
constexpr std::string_view kBetween = ", ";
// A name of a type has 1000 bytes at most.
constexpr std::size_t kLongestList = 800;

}  // namespace

std::string typeOfList(const std::string& datatype, const Listed& listed) {
  std::string values;
  for (const std::string& value : listed.values) {
    if (values.size() + value.size() > kLongestList) {
      values += std::string(kBetween) + std::to_string(listed.values.size()) + " in all";
      break;
    }
    values += (values.empty() ? "" : std::string(kBetween)) + value;
  }
  return datatype + std::string(kBegin) + listed.field + std::string(kAfterField) + values + "]";
}

std::optional<Listed> listedBy(const EventType& type) {
  if (!tellsList(type)) {
    return std::nullopt;
  }
  std::string_view rest = type.type;
  rest.remove_prefix(rest.find('[') + kBegin.size());
  rest.remove_suffix(1);
  const std::size_t end = rest.find(kAfterField);
  Listed listed{std::string(rest.substr(0, end)), {}};
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + kAfterField.size());
  while (!rest.empty()) {
    const std::size_t length = rest.find(kBetween);
    listed.values.emplace(rest.substr(0, length));
    rest.remove_prefix(length == std::string_view::npos ? rest.size() : length + kBetween.size());
  }
  return listed;
}

bool tellsList(const EventType& type) {
  const std::size_t begin = type.type.find('[');
  return begin != std::string::npos && type.type.back() == ']' &&
         type.type.compare(begin, kBegin.size(), kBegin) == 0;
}

}  // namespace self_awareness::core
