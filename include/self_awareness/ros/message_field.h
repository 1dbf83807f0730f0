#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace self_awareness::ros1 {

/// Reads one field of a serialized message by the message's definition, without its C++ type. The
/// field must be an integer, a bool or a string, and not in an array.
class MessageField {
 public:
  /// @param definition full text, with those of nested types, as in bags and connection headers
  /// @param datatype e.g. visualization_msgs/Marker
  /// @param path e.g. "action" or "header.frame_id"
  /// @throw std::invalid_argument names the datatype, the field and what is wrong with it
  MessageField(const std::string& definition, const std::string& datatype,
               const std::string& path);

  /// Value as text; strings are cut after 64 bytes.
  /// @throw std::out_of_range if the message ends before the end of the field
  std::string read(const std::uint8_t* data, std::size_t size) const;

 private:
  friend class DefinitionParser;

  // How to skip one piece of the message, or to read it.
  struct Step {
    enum class Kind { kSkipBytes, kSkipString, kSkipArray, kRead };
    Kind kind = Kind::kSkipBytes;
    std::size_t bytes = 0;      // kSkipBytes
    std::vector<Step> element;  // kSkipArray: steps across one element
    std::string type;           // kRead: built-in type
  };
  class Cursor;

  static void skip(const Step& step, Cursor& cursor);

  std::vector<Step> steps_;
};

}  // namespace self_awareness::ros1
