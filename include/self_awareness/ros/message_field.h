#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace self_awareness::ros1 {

/// Reads one field of a serialized message by the message's definition, without its C++ type. The
/// field must be an integer, a bool or a string, and not in an array. Definitions are bounded
/// (docs/encoding.md): they come from whoever publishes.
class MessageField {
 public:
  /// @param definition full text, with those of nested types, as in bags and connection headers
  /// @param datatype e.g. visualization_msgs/Marker
  /// @param path e.g. "action" or "header.frame_id"
  /// @throw std::invalid_argument names the datatype, the field and what is wrong with it
  MessageField(const std::string& definition, const std::string& datatype,
               const std::string& path);

  /// Value as text, in UTF-8; strings are cut after 64 bytes. The time it takes follows the size
  /// of the message.
  /// @throw std::out_of_range if the message ends before the end of the field
  std::string read(const std::uint8_t* data, std::size_t size) const;

 private:
  struct Way;

  std::shared_ptr<const Way> way_;  // to the field, and its type
};

}  // namespace self_awareness::ros1
