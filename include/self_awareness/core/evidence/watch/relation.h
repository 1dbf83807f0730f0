#pragma once

#include <cstddef>
#include <cstdint>

namespace self_awareness::core::evidence {

/// A relation between two event types, and what speaks for it (docs/method.md, section 3.6).
struct Relation {
  bool watched = false;    ///< what speaks for it is enough
  bool reaches = false;    ///< messages of the one reach the node of the other
  bool irregular = false;  ///< the one says more about the other than its own history does
  double spread = 1;       ///< share of a period that the delays of all starts lie in, 0 to 1
  std::size_t starts = 0;  ///< that show it
  std::size_t starts_needed = 0;  ///< with which it would be watched; 0: it is, or no number helps
};

/// Probability that independent timers show as narrow a spread in all starts by chance.
double byChance(const Relation& relation);

/// What the delays between two event types said in a recording.
enum class Said : std::uint8_t {
  kNothing,    ///< there were too few
  kAsUsual,    ///< as much as in training
  kMisleading  ///< less than in training, in a part of the recording
};

}  // namespace self_awareness::core::evidence
