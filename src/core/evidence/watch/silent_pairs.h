#pragma once

#include <cstddef>

#include "self_awareness/core/evidence/count/halves.h"
#include "self_awareness/core/evidence/count/pair_set.h"
#include "self_awareness/core/evidence/tuning.h"
#include "self_awareness/core/verdict/source_graph.h"

namespace self_awareness::core::evidence {

/// Robots of so many event types keep the counts of all pairs: beyond, they fill files and memory.
constexpr std::size_t kMostTypesOfAllPairs = 200;

/// The pairs that say so little that they are not watched, and most likely never will be, although
/// enough is known of them (docs/method.md, section 3.1).
/// @param counts of the whole training, by half, with the same event types
PairSet silentPairs(const Halves& counts, const SourceGraph& graph, const Tuning& tuning);

/// Leaves them out for good if there are more than kMostTypesOfAllPairs event types. What is
/// watched (watch()) stays the same.
void leaveOutSilentPairs(Halves& counts, const SourceGraph& graph, const Tuning& tuning);

}  // namespace self_awareness::core::evidence
