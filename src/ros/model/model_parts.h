#pragma once

#include "bytes.h"
#include "self_awareness/core/evidence/count/statistics.h"
#include "self_awareness/core/paper/delay_statistics.h"
#include "self_awareness/ros/model/model_file.h"

namespace self_awareness::ros1 {

// The parts of a model as bytes (msg/ModelPart.msg), for files and for other processes. What reads
// them throws std::invalid_argument, which names the contradiction.

/// All but the counts of further training, and the version.
void writeModel(const TrainedModel& model, ByteWriter& bytes);
/// Channels that the bytes watch and this version does not have are in left_out; what is said of
/// them is left out.
TrainedModel readModel(ByteReader& bytes);

/// The delays from all event types to one.
void writeDelays(const core::paper::DelayStatistics& statistics, core::EventId to,
                 ByteWriter& bytes);
void readDelays(ByteReader& bytes, core::EventId to, core::paper::DelayStatistics& statistics);

/// The counts of each event type, without its pairs.
void writeCounts(const core::evidence::Statistics& statistics, ByteWriter& bytes);
/// @param vocabulary of the event types
core::evidence::Statistics readCounts(ByteReader& bytes, const core::Vocabulary& vocabulary);

/// The counts of an event type and its partners.
void writePairs(const core::evidence::Statistics& statistics, core::EventId id, ByteWriter& bytes);
void readPairs(ByteReader& bytes, core::EventId id, core::evidence::Statistics& statistics);

// What cannot be in a model that was read, or fills memory or time. Each throws
// std::invalid_argument, which says what it is.

/// All but its tracks.
void checkModel(const TrainedModel& model);
/// Counts of one half of the training.
void checkCounts(const core::evidence::Statistics& statistics);

/// Leaves out tracks whose channel is null, and all that is said of them.
void removeUnknownTracks(core::Model& model);

}  // namespace self_awareness::ros1
