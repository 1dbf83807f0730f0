#pragma once

#include <cstddef>
#include <vector>

#include "self_awareness/core/evidence/channel/track.h"
#include "self_awareness/core/evidence/count/halves.h"
#include "self_awareness/core/evidence/count/statistics.h"
#include "self_awareness/core/evidence/tuning.h"
#include "self_awareness/core/verdict/source_graph.h"

namespace self_awareness::core::evidence {

/// What the evidence detector keeps of a training: what is watched, and the counts that this
/// needs.
struct Watched {
  std::vector<Track> tracks;  ///< what is watched, channel by channel
  Halves halves;              ///< of the training, with the same event types
  Tuning tuning;              ///< by which they were chosen
};

/// Lets every channel choose what it watches, by the counts of the two halves of the training
/// (docs/method.md, section 3). Each half gets the event types that it lacks from the other.
/// @param graph who hears whom; empty: not known
/// @throw std::invalid_argument if a channel that is switched off does not exist
Watched watch(const Statistics& first, const Statistics& second, const SourceGraph& graph = {},
              const Tuning& tuning = {});

/// Checks tracks that come from outside.
/// @param types number of event types
/// @throw std::invalid_argument if a track is of none of them, or there twice
void checkTracks(const std::vector<Track>& tracks, std::size_t types);

}  // namespace self_awareness::core::evidence
