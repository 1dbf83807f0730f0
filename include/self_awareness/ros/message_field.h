#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

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
  struct Way;

  /// Where the field begins in a message.
  MessageCursor at(const std::uint8_t* data, std::size_t size) const;

  std::shared_ptr<const Way> way_;  // to the field, and its type
};

}  // namespace self_awareness::ros1
