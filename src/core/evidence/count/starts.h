#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace self_awareness::core::evidence {

/// When something was recorded [ns], and of whom.
struct Span {
  std::int64_t start = 0;        ///< first stamp
  std::int64_t end = 0;          ///< last stamp
  std::int64_t robot_start = 0;  ///< when the robot was started; 0: not known
  std::string robot{};           ///< its name; empty: not known
};

/// Numbers the starts that recordings come from, from 0; a start is of one robot. Where it is
/// known when the robot was started, this tells starts apart; other recordings are of one start if
/// they overlap, or follow each other within a minute (docs/method.md, section 3.1).
std::vector<std::size_t> startsOf(const std::vector<Span>& recordings, std::int64_t same_start);

/// Number of these starts.
std::size_t numberOfStarts(const std::vector<Span>& recordings, std::int64_t same_start);

/// Numbers what recordings are samples of, from 0: robots where they are of several (those without
/// a name are one), else starts. What a robot never did may be what the next one does.
std::vector<std::size_t> samplesOf(const std::vector<Span>& recordings, std::int64_t same_start);

}  // namespace self_awareness::core::evidence
