#pragma once

#include <set>

#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/verdict/source_graph.h"

namespace self_awareness::core {

/// What events do not say of who sends now: two may have one name, and who plays a recording is no
/// component of the robot.
struct Senders {
  /// What comes from two senders of one name.
  std::set<SourceGraph::Publication> doubled;
  /// What players play on this robot: types without events, whose sources are the players.
  std::set<EventType> played;
};

inline bool operator==(const Senders& a, const Senders& b) {
  return a.doubled == b.doubled && a.played == b.played;
}
inline bool operator!=(const Senders& a, const Senders& b) {
  return !(a == b);
}

}  // namespace self_awareness::core
