#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace self_awareness::ros1 {

/// Of rosgraph_msgs/Log, whose layout readLogLine() knows.
constexpr char kMd5OfLog[] = "acffd30cd6b6de30f120938c17c593fb";

/// A line that a node wrote to /rosout.
struct SaidLine {
  std::string node;        ///< its stable name, as the line says it
  std::uint8_t level = 0;  ///< as in rosgraph_msgs/Log: 1 DEBUG, 2 INFO, 4 WARN, 8 ERROR, 16 FATAL
  std::string text;        ///< printable, in one line, at most kLongestLine bytes of it
};

constexpr std::size_t kLongestLine = 500;

/// What a serialized rosgraph_msgs/Log says; none: it is shorter than it says.
std::optional<SaidLine> readLogLine(const std::uint8_t* data, std::size_t size);

}  // namespace self_awareness::ros1
