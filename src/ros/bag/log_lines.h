#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "self_awareness/ros/encoding.h"

namespace self_awareness::ros1 {

/// Of rosgraph_msgs/Log, whose layout readLogLine() knows.
constexpr char kMd5OfLog[] = "acffd30cd6b6de30f120938c17c593fb";

/// A line that a node wrote to /rosout.
struct LogLine {
  std::int64_t stamp = 0;  ///< when the bag got it [ns]; 0: it is in none
  std::string node;        ///< its stable name, as the line says it
  std::uint8_t level = 0;  ///< as in rosgraph_msgs/Log: 1 DEBUG, 2 INFO, 4 WARN, 8 ERROR, 16 FATAL
  std::string text;        ///< printable, in one line, at most kLongestLine bytes of it
};

constexpr std::size_t kLongestLine = 500;

/// What a serialized rosgraph_msgs/Log says; none: it is shorter than it says.
std::optional<LogLine> readLogLine(const std::uint8_t* data, std::size_t size);

/// Messages of /rosout that are read for the last lines of a node, at most so many: others may
/// write much where it writes nothing.
constexpr std::size_t kMostLinesRead = 20000;

/// Whose last lines are asked for.
struct LogQuery {
  std::string node;        ///< as events call it
  std::int64_t until = 0;  ///< lines up to this time [ns]
};

/// The last lines of nodes in a recording, each in the order in which they came; none where a file
/// has neither /rosout nor /rosout_agg.
/// @param paths of the files of the recording, in their order
/// @param encoder gives nodes their names
/// @param most lines of each
/// @throw BagError if the bag cannot be read
std::vector<std::vector<LogLine>> lastLogLines(const std::vector<std::string>& paths,
                                               const Encoder& encoder,
                                               const std::vector<LogQuery>& queries,
                                               std::size_t most);

}  // namespace self_awareness::ros1
