#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace self_awareness::ros1 {

/// How to pass over one piece of a serialized message. Each step takes one byte at least, so that
/// the time to cross a message follows its size, whatever its definition says.
struct MessageStep {
  enum class Kind {
    kBytes,  ///< always the same number of them
    kString,
    kArray
  };
  Kind kind = Kind::kBytes;
  std::uint64_t bytes = 0;              ///< of kBytes, more than 0
  std::optional<std::uint32_t> length;  ///< of kArray; none: the message says it
  std::vector<MessageStep> element;     ///< of kArray: steps across one element
};
using MessageSteps = std::vector<MessageStep>;

/// The text that describes a message type: its fields, and those of the types in it
/// (wiki.ros.org/msg). It comes from whoever publishes: its size, its depth and the number of its
/// fields are bounded.
class MessageDefinition {
 public:
  /// The longest text [bytes]. That of an interactive marker, one of the longest, has 16 kB.
  static constexpr std::size_t kLongest = 1 << 20;
  /// Types may lie in each other so often; no message of ROS itself has more than 6.
  static constexpr int kDeepest = 32;
  /// The most fields, those of types in it counted wherever they occur.
  static constexpr int kMostFields = 10000;
  /// No message is larger [bytes]: roscpp closes a connection that announces more.
  static constexpr std::uint64_t kLargestMessage = 1000000000;

  /// @param text as in bags and in the headers of connections
  /// @param datatype e.g. visualization_msgs/Marker
  /// @throw std::invalid_argument if the text is too long
  MessageDefinition(const std::string& text, std::string datatype);

  /// A field of a type, as the text says it.
  struct Line {
    std::string type;   ///< in full and without brackets, e.g. uint8 or std_msgs/Header
    std::string array;  ///< "": no array, "[]": of any length, "[N]": of N elements
    std::string name;

    bool operator==(const Line& other) const {
      return type == other.type && array == other.array && name == other.name;
    }
  };
  using Lines = std::vector<Line>;

  const std::string& datatype() const { return datatype_; }
  /// Whether a type is one of those that all messages are made of: numbers, times and string.
  static bool isBuiltIn(const std::string& type);
  /// The fields of a type, in their order.
  /// @throw std::invalid_argument if the definition of the type is missing
  const Lines& linesOf(const std::string& type) const;
  /// The steps across each of them.
  /// @throw std::invalid_argument if a bound is exceeded, or the definition of a type is missing
  std::vector<MessageSteps> stepsOf(const std::string& type) const;

  struct Field {
    MessageSteps before;  ///< what lies before it
    std::string type;     ///< an integer, bool or string, or another number
  };
  /// @param path e.g. "action" or "header.frame_id"
  /// @throw std::invalid_argument if there is no such field, it is of another type or in an array,
  /// or a bound is exceeded; says what is wrong
  /// @param numbers whether it must be a number or a bool; else it must be an integer, bool or
  /// string
  Field field(const std::string& path, bool numbers = false) const;
  /// A field of all elements of an array.
  struct ListField {
    MessageSteps before;                  ///< what lies before the array
    std::optional<std::uint32_t> length;  ///< of the array; none: the message says it
    MessageSteps element;                 ///< across one
    Field field;                          ///< in an element
  };
  /// @param path as for field(), e.g. "transforms.child_frame_id", or "name" of an array of
  /// strings
  /// @return none: it goes through no array
  /// @throw std::invalid_argument as field(), or it goes through more than one array
  std::optional<ListField> listField(const std::string& path) const;
  /// The steps across the whole message.
  /// @throw std::invalid_argument if a bound is exceeded, or the definition of a type is missing
  MessageSteps whole() const;

 private:
  class Expansion;

  static Lines parse(std::istream& text, std::string& next_type, const std::string& package);
  /// Along a path, up to its end or to the first array on it.
  struct Way {
    Field field;
    const Line* array = nullptr;  // in which it ends
    std::string rest;             // of the path, behind the array
  };
  Way wayTo(const std::string& type, const std::string& path) const;
  /// @throw std::invalid_argument if a field of a type cannot be read
  void check(const std::string& type, bool numbers) const;

  std::string datatype_;
  std::map<std::string, Lines> types_;
};

}  // namespace self_awareness::ros1
