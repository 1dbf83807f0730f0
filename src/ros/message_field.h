#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "message_definition.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/stream/listed.h"

namespace self_awareness::ros1 {

class MessageCursor;

/// Reads one field of a serialized message by the message's definition, without its C++ type. The
/// field must not be in an array. Definitions are bounded
/// (docs/monitor.md): they come from whoever publishes.
class MessageField {
 public:
  enum class Kind {
    kText,   ///< an integer, a bool or a string, as text
    kNumber  ///< an integer, a bool or a floating point number, as number
  };

  /// @param definition full text, with those of nested types, as in bags and connection headers
  /// @param datatype e.g. visualization_msgs/Marker
  /// @param path e.g. "action" or "header.frame_id"
  /// @throw std::invalid_argument names the datatype, the field and what is wrong with it
  MessageField(const std::string& definition, const std::string& datatype, const std::string& path,
               Kind kind = Kind::kText);

  /// Value as text, in UTF-8; strings are cut after 64 bytes. The time it takes follows the size
  /// of the message.
  /// @throw std::out_of_range if the message ends before the end of the field
  std::string read(const std::uint8_t* data, std::size_t size) const;
  /// Value of a field of Kind::kNumber.
  /// @throw std::out_of_range if the message ends before the end of the field
  double number(const std::uint8_t* data, std::size_t size) const;

 private:
  /// Where the field begins in a message.
  MessageCursor at(const std::uint8_t* data, std::size_t size) const;

  MessageDefinition::Field field_;
};

/// Reads what the messages of one connection list, and knows when there is something to tell.
class ListedField {
 public:
  /// What lasts is told again so often [ns].
  static constexpr std::int64_t kAgain = core::kNanosecondsPerSecond;
  /// Who has more lists than so many invents them: they are not told apart any more.
  static constexpr std::size_t kMostLists = 16;

  /// @param path of the field that `field` was found by
  ListedField(std::string path, MessageDefinition::ListField field);

  /// Takes in the next message.
  /// @param stamp [ns]
  /// @return what it lists, where that is another than before, or was told kAgain ago: texts, or
  /// the largest number; none: there is nothing to tell
  /// @throw std::out_of_range if the message is shorter than its definition
  std::optional<core::Listed> next(const std::uint8_t* data, std::size_t size, std::int64_t stamp);

 private:
  /// Calls use() with the type of each element's field, and a cursor that is at it.
  template <typename Use>
  void forEach(const std::uint8_t* data, std::size_t size, const Use& use) const;
  std::set<std::string> read(const std::uint8_t* data, std::size_t size) const;
  /// Whether a message lists the same in the same order as the one before: most do.
  bool isAsBefore(const std::uint8_t* data, std::size_t size);

  std::string path_;
  MessageDefinition::ListField field_;
  std::string texts_;         // of the last message
  std::string texts_before_;  // of the one before
  std::set<std::string> last_;
  std::optional<std::int64_t> told_;  // when [ns]
  std::set<std::set<std::string>> lists_;
};

}  // namespace self_awareness::ros1
