#include "message_upgrade.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "message_cursor.h"
#include "text.h"

namespace self_awareness::ros1 {

/// From the one layout of a type to the other.
struct MessageUpgrade::Layout {
  /// A field of the new layout.
  struct Field {
    std::optional<std::size_t> piece;        // of the old message; none: it lacks the field
    std::vector<std::uint8_t> blank;         // takes its place then
    std::shared_ptr<const Layout> elements;  // none: the piece is copied as it is
    bool is_array = false;
    std::optional<std::uint32_t> length;  // of the array; none: the message says it
  };

  std::vector<MessageSteps> pieces;  // of the old message, in its order
  std::vector<Field> fields;         // in the new order
  bool takes_bytes = false;          // each old message of this type
};

class MessageUpgrade::Builder {
 public:
  Builder(const MessageDefinition& from, const MessageDefinition& to) : from_(from), to_(to) {}

  std::shared_ptr<const Layout> layoutOf(const std::string& type) const {
    auto layout = std::make_shared<Layout>();
    std::vector<MessageSteps> steps = from_.stepsOf(type);  // bounds their number
    const MessageDefinition::Lines& old = from_.linesOf(type);
    std::vector<std::optional<std::size_t>> taken(old.size());  // index in the new fields
    const std::vector<MessageSteps> blank = to_.stepsOf(type);
    for (const MessageDefinition::Line& line : to_.linesOf(type)) {
      const auto same = std::find_if(old.begin(), old.end(),
                                     [&](const auto& each) { return each.name == line.name; });
      if (same != old.end()) {
        taken[static_cast<std::size_t>(same - old.begin())] = layout->fields.size();
        layout->fields.push_back(fieldFrom(type, *same, line));
      } else {
        const MessageSteps& missing = blank[layout->fields.size()];
        appendBlank(missing, layout->fields.emplace_back().blank);
      }
    }
    for (std::size_t k = 0; k < old.size(); ++k) {
      const bool takes_bytes = !steps[k].empty();
      layout->takes_bytes = layout->takes_bytes || takes_bytes;
      if (taken[k]) {
        layout->fields[*taken[k]].piece = layout->pieces.size();
      }
      if (taken[k] || takes_bytes) {  // a field that takes no byte must take no time
        layout->pieces.push_back(std::move(steps[k]));
      }
    }
    return layout;
  }

 private:
  Layout::Field fieldFrom(const std::string& type, const MessageDefinition::Line& old,
                          const MessageDefinition::Line& line) const {
    if (old.type != line.type || old.array != line.array) {
      throw std::invalid_argument("field " + line.name + " of " + type + " is of the type " +
                                  printable(old.type + old.array, kLongestQuote) +
                                  " in the file, and here " + line.type + line.array);
    }
    Layout::Field field;
    if (!sameLayout(line.type)) {
      field.elements = layoutOf(line.type);
      field.is_array = !line.array.empty();
      if (field.is_array && line.array != "[]") {
        field.length = static_cast<std::uint32_t>(std::stoul(line.array.substr(1)));
      }
    }
    return field;
  }

  // Follows the new definition, which ends, however deep the old one goes.
  bool sameLayout(const std::string& type) const {
    if (MessageDefinition::isBuiltIn(type)) {
      return true;
    }
    const MessageDefinition::Lines& lines = to_.linesOf(type);
    return from_.linesOf(type) == lines &&
           std::all_of(lines.begin(), lines.end(),
                       [this](const auto& line) { return sameLayout(line.type); });
  }

  /// Zeros, and what is empty.
  static void appendBlank(const MessageSteps& steps, std::vector<std::uint8_t>& blank) {
    for (const MessageStep& step : steps) {
      const bool is_array = step.kind == MessageStep::Kind::kArray && step.length;
      const bool is_bytes = step.kind == MessageStep::Kind::kBytes;
      blank.resize(blank.size() + (is_array ? 0 : is_bytes ? step.bytes : sizeof(std::uint32_t)));
      for (std::uint32_t k = 0; is_array && k < *step.length; ++k) {
        appendBlank(step.element, blank);
      }
    }
  }

  const MessageDefinition& from_;
  const MessageDefinition& to_;
};

class MessageUpgrade::Writer {
 public:
  void append(const Layout& layout, MessageCursor& cursor) {
    std::vector<std::string_view> pieces;
    pieces.reserve(layout.pieces.size());
    for (const MessageSteps& steps : layout.pieces) {
      const std::string_view before = cursor.rest();
      cursor.cross(steps, [](std::string_view /*passed*/) {});
      pieces.push_back(before.substr(0, before.size() - cursor.rest().size()));
    }
    for (const Layout::Field& field : layout.fields) {
      if (!field.piece) {
        append(field.blank.data(), field.blank.size());
      } else if (field.elements) {
        append(field, pieces[*field.piece]);
      } else {
        append(pieces[*field.piece].data(), pieces[*field.piece].size());
      }
    }
  }

  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  void append(const Layout::Field& field, std::string_view piece) {
    MessageCursor cursor(reinterpret_cast<const std::uint8_t*>(piece.data()), piece.size());
    std::uint32_t elements = 1;
    if (field.is_array) {
      elements = field.length ? *field.length : cursor.number<std::uint32_t>();
      if (!field.length) {
        append(&elements, sizeof elements);
      }
      if (elements > 0 && !field.elements->takes_bytes) {
        throw std::invalid_argument("an array in it has elements without any field");
      }
    }
    for (std::uint32_t k = 0; k < elements; ++k) {
      append(*field.elements, cursor);
    }
  }

  void append(const void* data, std::size_t size) {
    if (bytes_.size() + size > MessageDefinition::kLargestMessage) {
      throw std::invalid_argument("it is larger than a message can be");
    }
    const auto* begin = static_cast<const std::uint8_t*>(data);
    bytes_.insert(bytes_.end(), begin, begin + size);
  }

  std::vector<std::uint8_t> bytes_;
};

MessageUpgrade::MessageUpgrade(const MessageDefinition& from, const MessageDefinition& to)
    : layout_(Builder(from, to).layoutOf(to.datatype())) {}

std::vector<std::uint8_t> MessageUpgrade::apply(const std::uint8_t* data, std::size_t size) const {
  MessageCursor cursor(data, size);
  Writer writer;
  try {
    writer.append(*layout_, cursor);
  } catch (const std::out_of_range&) {
    throw std::invalid_argument("a length in it is wrong");
  }
  if (!cursor.atEnd()) {
    throw std::invalid_argument("there is more in it than belongs to it");
  }
  return writer.take();
}

}  // namespace self_awareness::ros1
