#pragma once

#include <cstdint>
#include <string>

namespace self_awareness::core {

/// What a model says of a recording, or a part of one, that it was learned from or calibrated on.
struct RecordingInfo {
  std::string bag;         ///< the file's name, without its folder
  std::int64_t start = 0;  ///< of the part used [ns]
  std::int64_t end = 0;    ///< [ns]
  std::uint64_t events = 0;
  std::int64_t robot_start = 0;  ///< when the robot was started [ns]; 0: not known
  /// Over the whole recording: it is the same under another name, and says which half of a
  /// training the recording belongs to (evidence::halfOf()).
  std::uint64_t fingerprint = 0;
  std::string robot{};  ///< its name; empty: not known
};

}  // namespace self_awareness::core
