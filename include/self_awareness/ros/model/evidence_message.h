#pragma once

#include <vector>

#include "self_awareness/Evidence.h"
#include "self_awareness/EvidenceCalibration.h"
#include "self_awareness/EvidencePairs.h"
#include "self_awareness/Track.h"
#include "self_awareness/core/evidence/model.h"
#include "self_awareness/core/evidence/statistics.h"

namespace self_awareness::ros1 {

/// Counts with all their pairs.
self_awareness::Evidence toMessage(const core::evidence::Statistics& statistics);
/// The counts of an event type and its partners.
self_awareness::EvidencePairs pairsMessage(const core::evidence::Statistics& statistics,
                                           core::EventId id);
/// @param vocabulary whose ids the message uses
/// @throw std::invalid_argument says what in the message contradicts itself
core::evidence::Statistics fromMessage(const self_awareness::Evidence& message,
                                       const core::Vocabulary& vocabulary);
/// Gives an event type the partners that a message holds.
/// @throw std::invalid_argument says what in the message contradicts itself or the event types
void setPairs(const self_awareness::EvidencePairs& message,
              core::evidence::Statistics& statistics);

self_awareness::Track toMessage(const core::evidence::Track& track);
/// @throw std::invalid_argument if there is no such channel
core::evidence::Track fromMessage(const self_awareness::Track& message);

core::evidence::Limits limitsOf(const self_awareness::EvidenceCalibration& message);

}  // namespace self_awareness::ros1
