#include "message_field.h"

#include <stdexcept>
#include <string_view>
#include <utility>

#include "message_cursor.h"

namespace self_awareness::ros1 {

MessageField::MessageField(const std::string& definition, const std::string& datatype,
                           const std::string& path, Kind kind) {
  try {
    field_ = MessageDefinition(definition, datatype).field(path, kind == Kind::kNumber);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("type field " + datatype + ": " + path + ": " + error.what());
  }
}

std::string MessageField::read(const std::uint8_t* data, std::size_t size) const {
  MessageCursor cursor = at(data, size);
  return textOf(field_.type, cursor);
}

double MessageField::number(const std::uint8_t* data, std::size_t size) const {
  MessageCursor cursor = at(data, size);
  return withNumber(field_.type, cursor, [](auto number) { return static_cast<double>(number); });
}

MessageCursor MessageField::at(const std::uint8_t* data, std::size_t size) const {
  MessageCursor cursor(data, size);
  cursor.cross(field_.before, [](std::string_view /*passed*/) {});
  return cursor;
}

ListedField::ListedField(std::string path, MessageDefinition::ListField field)
    : path_(std::move(path)), field_(std::move(field)) {}

std::optional<core::Listed> ListedField::next(const std::uint8_t* data, std::size_t size,
                                              std::int64_t stamp) {
  const bool is_told = told_ && stamp >= *told_ && stamp - *told_ < kAgain;
  const bool is_as_before = isAsBefore(data, size);
  if (is_as_before && is_told) {
    return std::nullopt;
  }
  std::set<std::string> values = read(data, size);
  // An empty array says nothing of what else there is.
  if (values.empty() || (is_told && values == last_)) {
    return std::nullopt;
  }
  told_ = stamp;
  last_ = values;
  if (lists_.size() <= kMostLists) {
    lists_.insert(values);
  }
  return core::Listed{path_,
                      lists_.size() > kMostLists ? std::set<std::string>() : std::move(values)};
}

template <typename Use>
void ListedField::forEach(const std::uint8_t* data, std::size_t size, const Use& use) const {
  const auto pass = [](std::string_view /*passed*/) {};
  MessageCursor cursor(data, size);
  cursor.cross(field_.before, pass);
  const std::uint64_t length = field_.length ? *field_.length : cursor.number<std::uint32_t>();
  for (std::uint64_t i = 0; i < length && !field_.element.empty(); ++i) {
    MessageCursor element = cursor;
    cursor.cross(field_.element, pass);
    element.cross(field_.field.before, pass);
    use(field_.field.type, element);
  }
}

std::set<std::string> ListedField::read(const std::uint8_t* data, std::size_t size) const {
  std::set<std::string> values;
  std::optional<double> largest;  // of numbers
  forEach(data, size, [&](const std::string& type, MessageCursor& element) {
    if (type == "string") {
      values.insert(textOf(type, element));
      return;
    }
    withNumber(type, element, [&](auto number) {
      if (!largest || static_cast<double>(number) > *largest) {
        largest = static_cast<double>(number);
        values = {std::to_string(number)};
      }
    });
  });
  return values;
}

bool ListedField::isAsBefore(const std::uint8_t* data, std::size_t size) {
  std::swap(texts_, texts_before_);
  texts_.clear();
  forEach(data, size, [&](const std::string& type, MessageCursor& element) {
    if (type == "string") {
      texts_ += element.string();
    } else {
      withNumber(type, element, [&](auto number) { texts_ += std::to_string(number); });
    }
    texts_ += '\0';
  });
  return texts_ == texts_before_;
}

}  // namespace self_awareness::ros1
