#include "self_awareness/core/stream/event.h"

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <string_view>

#include "self_awareness/core/stream/listed.h"
#include "self_awareness/core/stream/mode.h"

namespace self_awareness::core {
namespace {

// What follows the datatype in a type of no message. No type field makes such a type: the name of
// the field comes first there, and has no blank. These are no strings, which would not be ready
// yet where another file's constants have such types.
constexpr std::string_view kLatched = "[latched]";
constexpr std::string_view kMode = "[mode: ";
constexpr std::string_view kLists = "[lists ";
// In a list.
constexpr std::string_view kAfterField = ": ";
constexpr std::string_view kBetween = ", ";
// A name of a type has 1000 bytes at most.
constexpr std::size_t kLongestList = 800;

/// What stands between such a beginning and the bracket at the end; none: it begins otherwise.
std::optional<std::string_view> saidAfter(std::string_view beginning, const EventType& type) {
  std::string_view said = type.type;
  said.remove_prefix(std::min(said.find('['), said.size()));
  if (said.substr(0, beginning.size()) != beginning || said.back() != ']') {
    return std::nullopt;
  }
  return said.substr(beginning.size(), said.size() - 1 - beginning.size());
}

}  // namespace

std::string valueOf(const EventType& type) {
  const std::size_t begin = type.type.find('[') + 1;
  const bool is_value = begin > 0 && type.type.find('=', begin) != std::string::npos &&
                        type.type.back() == ']' && !tellsList(type);
  return is_value ? type.type.substr(begin, type.type.size() - begin - 1) : "";
}

std::optional<EventType> withoutValue(const EventType& type) {
  const std::size_t end = type.type.find('[');
  return end == std::string::npos
             ? std::nullopt
             : std::optional(EventType{type.source, type.scope, type.type.substr(0, end)});
}

std::string toString(const EventType& type) {
  return (type.source.empty() ? "-" : type.source) + " " + type.scope + " " + type.type;
}

std::string inUtc(std::int64_t time, const char* format) {
  const auto seconds = static_cast<std::time_t>(time / kNanosecondsPerSecond);
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char text[64];
  std::strftime(text, sizeof text, format, &parts);
  return text;
}

std::string typeOfLatched(const std::string& datatype) {
  return datatype + std::string(kLatched);
}

bool isLatched(const EventType& type) {
  const std::size_t begin = type.type.find('[');
  return begin != std::string::npos && type.type.compare(begin, std::string::npos, kLatched) == 0;
}

std::string typeOfMode(const std::string& datatype, const std::string& mode) {
  return datatype + std::string(kMode) + mode + "]";
}

std::string modeOf(const EventType& type) {
  return std::string(saidAfter(kMode, type).value_or(""));
}

bool tellsMode(const EventType& type) {
  return saidAfter(kMode, type).has_value();
}

std::string typeOfList(const std::string& datatype, const Listed& listed) {
  std::string values;
  for (const std::string& value : listed.values) {
    if (values.size() + value.size() > kLongestList) {
      values += std::string(kBetween) + std::to_string(listed.values.size()) + " in all";
      break;
    }
    values += (values.empty() ? "" : std::string(kBetween)) + value;
  }
  return datatype + std::string(kLists) + listed.field + std::string(kAfterField) + values + "]";
}

std::optional<Listed> listedBy(const EventType& type) {
  const std::optional<std::string_view> said = saidAfter(kLists, type);
  if (!said) {
    return std::nullopt;
  }
  const std::size_t end = said->find(kAfterField);
  Listed listed{std::string(said->substr(0, end)), {}};
  std::string_view rest = *said;
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + kAfterField.size());
  while (!rest.empty()) {
    const std::size_t length = rest.find(kBetween);
    listed.values.emplace(rest.substr(0, length));
    rest.remove_prefix(length == std::string_view::npos ? rest.size() : length + kBetween.size());
  }
  return listed;
}

bool tellsList(const EventType& type) {
  return saidAfter(kLists, type).has_value();
}

}  // namespace self_awareness::core
