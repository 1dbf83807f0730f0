#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "self_awareness/ros/encoding.h"

namespace self_awareness::ros1 {

/// A line that a node wrote to /rosout.
struct LogLine {
  std::int64_t stamp = 0;  ///< when the bag got it [ns]
  std::uint8_t level = 0;  ///< as in rosgraph_msgs/Log: 1 DEBUG, 2 INFO, 4 WARN, 8 ERROR, 16 FATAL
  std::string text;        ///< printable, in one line, cut (SaidLine)
};

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
