#pragma once

#include "self_awareness/core/evidence/count/statistics.h"
#include "self_awareness/ros/model/model_file.h"

namespace self_awareness::ros1 {

// What cannot be in a model that was read, or fills memory or time. Each throws
// std::invalid_argument, which says what it is.

/// All but its tracks.
void checkModel(const TrainedModel& model);
/// Counts of one half of the training.
void checkCounts(const core::evidence::Statistics& statistics);

/// Leaves out tracks whose channel is null, and all that is said of them.
void removeUnknownTracks(core::Model& model);

}  // namespace self_awareness::ros1
