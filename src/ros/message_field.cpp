#include "self_awareness/ros/message_field.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <sstream>
#include <stdexcept>

namespace self_awareness::ros1 {
namespace {

constexpr std::size_t kLongestValue = 64;

const std::map<std::string, std::size_t>& builtInSizes() {
  static const std::map<std::string, std::size_t> kSizes = {
      {"bool", 1},   {"byte", 1},    {"char", 1},    {"int8", 1},   {"uint8", 1},
      {"int16", 2},  {"uint16", 2},  {"int32", 4},   {"uint32", 4}, {"int64", 8},
      {"uint64", 8}, {"float32", 4}, {"float64", 8}, {"time", 8},   {"duration", 8}};
  return kSizes;
}

bool readable(const std::string& type) {
  return type == "string" || (builtInSizes().count(type) > 0 && type != "float32" &&
                              type != "float64" && type != "time" && type != "duration");
}

struct FieldLine {
  std::string type;   // without brackets
  std::string array;  // "": no array, "[]": of any length, "[N]": of N elements
  std::string name;
};

using Fields = std::vector<FieldLine>;

std::string packageOf(const std::string& datatype) {
  return datatype.substr(0, datatype.find('/'));
}

// "Header" is the one type that every package may name without a package.
std::string fullType(const std::string& type, const std::string& package) {
  if (type == "string" || builtInSizes().count(type) > 0 || type.find('/') != std::string::npos) {
    return type;
  }
  return type == "Header" ? "std_msgs/Header" : package + "/" + type;
}

Fields parseFields(std::istream& lines, std::string& next_type, const std::string& package) {
  Fields fields;
  std::string line;
  next_type.clear();
  while (std::getline(lines, line)) {
    if (line.compare(0, 4, "====") == 0) {
      std::getline(lines, line);
      std::istringstream words(line);
      std::string keyword;
      words >> keyword >> next_type;  // "MSG: package/Type"
      break;
    }
    std::istringstream words(line.substr(0, line.find('#')));
    FieldLine field;
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

std::map<std::string, Fields> parseDefinition(const std::string& definition,
                                              const std::string& datatype) {
  std::map<std::string, Fields> types;
  std::istringstream lines(definition);
  std::string type = datatype;
  while (!type.empty()) {
    std::string next_type;
    types[type] = parseFields(lines, next_type, packageOf(type));
    type = next_type;
  }
  return types;
}

}  // namespace

/// Walks over a serialized message, never beyond its end.
class MessageField::Cursor {
 public:
  Cursor(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  const std::uint8_t* advance(std::size_t bytes) {
    if (bytes > size_) {
      throw std::out_of_range("the message is shorter than its definition says");
    }
    const std::uint8_t* here = data_;
    data_ += bytes;
    size_ -= bytes;
    return here;
  }
  template <typename T>
  T number() {
    T value;
    std::memcpy(&value, advance(sizeof value), sizeof value);
    return value;
  }
  std::string text() {
    const auto length = number<std::uint32_t>();
    const auto* begin = reinterpret_cast<const char*>(advance(length));
    return std::string(begin, std::min<std::size_t>(length, kLongestValue));
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

/// Turns a definition into the steps to one field of it.
class DefinitionParser {
 public:
  using Step = MessageField::Step;

  DefinitionParser(const std::string& definition, const std::string& datatype,
                   const std::string& path)
      : types_(parseDefinition(definition, datatype)), datatype_(datatype), path_(path) {}

  std::vector<Step> stepsToField() {
    std::vector<Step> steps;
    std::string type = datatype_;
    std::istringstream names(path_);
    std::string name;
    while (std::getline(names, name, '.')) {
      const Fields& fields = fieldsOf(type);
      const auto field = std::find_if(fields.begin(), fields.end(),
                                      [&](const FieldLine& line) { return line.name == name; });
      if (field == fields.end()) {
        fail("has no field '" + name + "'" + (type == datatype_ ? "" : " in its " + type));
      }
      if (!field->array.empty()) {
        fail("'" + name + "' is an array; name a single value");
      }
      for (auto before = fields.begin(); before != field; ++before) {
        appendSkip(*before, steps);
      }
      type = field->type;
    }
    if (types_.count(type) > 0) {
      fail("is a message itself; name one of its fields");
    }
    if (!readable(type)) {
      fail("is a " + type + "; only integers, bool and string tell what a message does");
    }
    Step read;
    read.kind = Step::Kind::kRead;
    read.type = type;
    steps.push_back(read);
    return steps;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw std::invalid_argument("type field " + datatype_ + ": " + path_ + ": " + what);
  }

  const Fields& fieldsOf(const std::string& type) const {
    const auto fields = types_.find(type);
    if (fields == types_.end()) {
      fail("the definition of " + type + " is missing");
    }
    return fields->second;
  }

  static void appendBytes(std::size_t bytes, std::vector<Step>& steps) {
    if (!steps.empty() && steps.back().kind == Step::Kind::kSkipBytes) {
      steps.back().bytes += bytes;
    } else {
      Step step;
      step.bytes = bytes;
      steps.push_back(step);
    }
  }

  void appendElement(const std::string& type, std::vector<Step>& steps) const {
    if (type == "string") {
      Step step;
      step.kind = Step::Kind::kSkipString;
      steps.push_back(step);
      return;
    }
    const auto size = builtInSizes().find(type);
    if (size != builtInSizes().end()) {
      appendBytes(size->second, steps);
      return;
    }
    for (const FieldLine& field : fieldsOf(type)) {
      appendSkip(field, steps);
    }
  }

  void appendSkip(const FieldLine& field, std::vector<Step>& steps) const {
    if (field.array.empty()) {
      appendElement(field.type, steps);
    } else if (field.array == "[]") {
      Step step;
      step.kind = Step::Kind::kSkipArray;
      appendElement(field.type, step.element);
      steps.push_back(step);
    } else {
      const std::size_t length = std::stoul(field.array.substr(1));
      for (std::size_t i = 0; i < length; ++i) {
        appendElement(field.type, steps);
      }
    }
  }

  std::map<std::string, Fields> types_;
  std::string datatype_;
  std::string path_;
};

MessageField::MessageField(const std::string& definition, const std::string& datatype,
                           const std::string& path)
    : steps_(DefinitionParser(definition, datatype, path).stepsToField()) {}

void MessageField::skip(const Step& step, Cursor& cursor) {
  switch (step.kind) {
    case Step::Kind::kSkipBytes:
      cursor.advance(step.bytes);
      break;
    case Step::Kind::kSkipString:
      cursor.advance(cursor.number<std::uint32_t>());
      break;
    case Step::Kind::kSkipArray: {
      const auto length = cursor.number<std::uint32_t>();
      if (step.element.size() == 1 && step.element[0].kind == Step::Kind::kSkipBytes) {
        cursor.advance(length * step.element[0].bytes);
        break;
      }
      for (std::uint32_t i = 0; i < length && !step.element.empty(); ++i) {
        for (const Step& inner : step.element) {
          skip(inner, cursor);
        }
      }
      break;
    }
    case Step::Kind::kRead:
      break;
  }
}

std::string MessageField::read(const std::uint8_t* data, std::size_t size) const {
  Cursor cursor(data, size);
  for (const Step& step : steps_) {
    skip(step, cursor);
  }
  const std::string& type = steps_.back().type;
  if (type == "string") {
    return cursor.text();
  }
  if (type == "int8" || type == "byte") {
    return std::to_string(cursor.number<std::int8_t>());
  }
  if (type == "int16") {
    return std::to_string(cursor.number<std::int16_t>());
  }
  if (type == "uint16") {
    return std::to_string(cursor.number<std::uint16_t>());
  }
  if (type == "int32") {
    return std::to_string(cursor.number<std::int32_t>());
  }
  if (type == "uint32") {
    return std::to_string(cursor.number<std::uint32_t>());
  }
  if (type == "int64") {
    return std::to_string(cursor.number<std::int64_t>());
  }
  if (type == "uint64") {
    return std::to_string(cursor.number<std::uint64_t>());
  }
  return std::to_string(cursor.number<std::uint8_t>());  // uint8, char, bool
}

}  // namespace self_awareness::ros1
