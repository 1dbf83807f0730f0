#include "message_definition.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "text.h"

namespace self_awareness::ros1 {
namespace {

constexpr std::size_t kMostDigits = 10;  // of a length of 32 bits

[[noreturn]] void fail(const std::string& what) {
  throw std::invalid_argument(what);
}

const std::map<std::string, std::uint64_t>& builtInSizes() {
  static const std::map<std::string, std::uint64_t> kSizes = {
      {"bool", 1},   {"byte", 1},    {"char", 1},    {"int8", 1},   {"uint8", 1},
      {"int16", 2},  {"uint16", 2},  {"int32", 4},   {"uint32", 4}, {"int64", 8},
      {"uint64", 8}, {"float32", 4}, {"float64", 8}, {"time", 8},   {"duration", 8}};
  return kSizes;
}

bool readable(const std::string& type) {
  return type == "string" || (builtInSizes().count(type) > 0 && type != "float32" &&
                              type != "float64" && type != "time" && type != "duration");
}

std::string packageOf(const std::string& datatype) {
  return datatype.substr(0, datatype.find('/'));
}

// "Header" is the one type that every package may name without a package.
std::string fullType(const std::string& type, const std::string& package) {
  if (MessageDefinition::isBuiltIn(type) || type.find('/') != std::string::npos) {
    return type;
  }
  return type == "Header" ? "std_msgs/Header" : package + "/" + type;
}

// Of "[N]".
std::uint32_t lengthOf(const std::string& array) {
  const std::string digits = array.substr(1, array.size() - 2);
  const bool number =
      array.size() > 2 && array.back() == ']' && digits.size() <= kMostDigits &&
      std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
  const std::uint64_t length = number ? std::stoull(digits) : 0;
  if (!number || length > MessageDefinition::kLargestMessage) {
    fail("has an array of an impossible length, " + quote(array));
  }
  return static_cast<std::uint32_t>(length);
}

}  // namespace

/// Writes out fields as steps, within the bounds.
class MessageDefinition::Expansion {
 public:
  explicit Expansion(const MessageDefinition& definition) : definition_(definition) {}

  void append(const Line& line, MessageSteps& steps) {
    if (++fields_ > kMostFields) {
      fail("has more than " + std::to_string(kMostFields) + " fields");
    }
    if (line.array.empty()) {
      appendElement(line.type, steps);
      return;
    }
    MessageStep array;
    array.kind = MessageStep::Kind::kArray;
    appendElement(line.type, array.element);
    if (line.array == "[]") {
      steps.push_back(std::move(array));
      return;
    }
    array.length = lengthOf(line.array);
    if (*array.length == 0 || array.element.empty()) {
      return;
    }
    if (array.element.size() == 1 && array.element[0].kind == MessageStep::Kind::kBytes) {
      appendBytes(*array.length * array.element[0].bytes, steps);
    } else {
      steps.push_back(std::move(array));
    }
  }

 private:
  static void appendBytes(std::uint64_t bytes, MessageSteps& steps) {
    if (steps.empty() || steps.back().kind != MessageStep::Kind::kBytes) {
      steps.emplace_back();
    }
    steps.back().bytes += bytes;
    if (steps.back().bytes > kLargestMessage) {
      fail("is longer than a message can be");
    }
  }

  void appendElement(const std::string& type, MessageSteps& steps) {
    if (type == "string") {
      steps.emplace_back().kind = MessageStep::Kind::kString;
      return;
    }
    const auto size = builtInSizes().find(type);
    if (size != builtInSizes().end()) {
      appendBytes(size->second, steps);
      return;
    }
    if (++depth_ > kDeepest) {
      fail("has types in each other more than " + std::to_string(kDeepest) +
           " deep, or in a ring");
    }
    for (const Line& line : definition_.linesOf(type)) {
      append(line, steps);
    }
    --depth_;
  }

  const MessageDefinition& definition_;
  int depth_ = 0;
  int fields_ = 0;
};

MessageDefinition::MessageDefinition(const std::string& text, std::string datatype)
    : datatype_(std::move(datatype)) {
  if (text.size() > kLongest) {
    fail("has a definition of more than " + std::to_string(kLongest) + " bytes");
  }
  std::istringstream lines(text);
  std::string type = datatype_;
  while (!type.empty()) {
    std::string next_type;
    types_[type] = parse(lines, next_type, packageOf(type));
    type = next_type;
  }
}

MessageDefinition::Lines MessageDefinition::parse(std::istream& text, std::string& next_type,
                                                  const std::string& package) {
  Lines fields;
  std::string line;
  next_type.clear();
  while (std::getline(text, line)) {
    if (line.compare(0, 4, "====") == 0) {
      std::getline(text, line);
      std::istringstream words(line);
      std::string keyword;
      words >> keyword >> next_type;  // "MSG: package/Type"
      break;
    }
    std::istringstream words(line.substr(0, line.find('#')));
    Line field;
    // A constant has a "=" after its name.
    if (!(words >> field.type >> field.name) || line.find('=') < line.find('#')) {
      continue;
    }
    const std::size_t bracket = field.type.find('[');
    if (bracket != std::string::npos) {
      field.array = field.type.substr(bracket);
      field.type.erase(bracket);
    }
    field.type = fullType(field.type, package);
    fields.push_back(field);
  }
  return fields;
}

const MessageDefinition::Lines& MessageDefinition::linesOf(const std::string& type) const {
  const auto lines = types_.find(type);
  if (lines == types_.end()) {
    fail("the definition of " + printable(type, kLongestQuote) + " is missing");
  }
  return lines->second;
}

MessageDefinition::Way MessageDefinition::wayTo(const std::string& type,
                                                const std::string& path) const {
  Way way;
  way.field.type = type;
  Expansion expansion(*this);
  std::istringstream names(path);
  std::string name;
  while (way.array == nullptr && std::getline(names, name, '.')) {
    const Lines& lines = linesOf(way.field.type);
    const auto line = std::find_if(lines.begin(), lines.end(),
                                   [&](const Line& each) { return each.name == name; });
    if (line == lines.end()) {
      fail("has no field " + quote(name) +
           (way.field.type == datatype_ ? ""
                                        : " in its " + printable(way.field.type, kLongestQuote)));
    }
    for (auto before = lines.begin(); before != line; ++before) {
      expansion.append(*before, way.field.before);
    }
    way.field.type = line->type;
    way.array = line->array.empty() ? nullptr : &*line;
  }
  std::getline(names, way.rest, '\0');
  return way;
}

void MessageDefinition::check(const std::string& type, bool numbers) const {
  if (types_.count(type) > 0) {
    fail("is a message itself; name one of its fields");
  }
  if (numbers && (!isBuiltIn(type) || type == "string" || type == "time" || type == "duration")) {
    fail("is a " + printable(type, kLongestQuote) + "; only numbers have classes");
  }
  if (!numbers && !readable(type)) {
    fail("is a " + printable(type, kLongestQuote) +
         "; only integers, bool and string tell what a message does");
  }
}

MessageDefinition::Field MessageDefinition::field(const std::string& path, bool numbers) const {
  Way way = wayTo(datatype_, path);
  if (way.array != nullptr) {
    fail(quote(way.array->name) + " is an array; name a single value");
  }
  check(way.field.type, numbers);
  return std::move(way.field);
}

std::optional<MessageDefinition::ListField> MessageDefinition::listField(
    const std::string& path) const {
  Way way = wayTo(datatype_, path);
  if (way.array == nullptr) {
    return std::nullopt;
  }
  ListField found;
  found.before = std::move(way.field.before);
  found.length =
      way.array->array == "[]" ? std::nullopt : std::optional(lengthOf(way.array->array));
  Expansion(*this).append({way.field.type, "", way.array->name}, found.element);
  Way inner = wayTo(way.field.type, way.rest);
  if (inner.array != nullptr) {
    fail(quote(inner.array->name) + " is an array in an array; name a field of one array");
  }
  check(inner.field.type, false);
  found.field = std::move(inner.field);
  return found;
}

bool MessageDefinition::isBuiltIn(const std::string& type) {
  return type == "string" || builtInSizes().count(type) > 0;
}

std::vector<MessageSteps> MessageDefinition::stepsOf(const std::string& type) const {
  std::vector<MessageSteps> steps;
  Expansion expansion(*this);
  for (const Line& line : linesOf(type)) {
    expansion.append(line, steps.emplace_back());
  }
  return steps;
}

MessageSteps MessageDefinition::whole() const {
  MessageSteps steps;
  Expansion expansion(*this);
  for (const Line& line : linesOf(datatype_)) {
    expansion.append(line, steps);
  }
  return steps;
}

}  // namespace self_awareness::ros1
