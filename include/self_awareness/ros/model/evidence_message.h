#pragma once

#include <vector>

#include "self_awareness/Evidence.h"
#include "self_awareness/EvidencePairs.h"
#include "self_awareness/RecordingFindings.h"
#include "self_awareness/Relation.h"
#include "self_awareness/Track.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/evidence/count/statistics.h"
#include "self_awareness/core/evidence/limits/limits.h"

namespace self_awareness::ros1 {

/// Message with counts and all their pairs.
self_awareness::Evidence toMessage(const core::evidence::Statistics& statistics);
/// Message with the counts of an event type and its partners.
self_awareness::EvidencePairs pairsMessage(const core::evidence::Statistics& statistics,
                                           core::EventId id);
/// @param vocabulary with the ids that the message uses
/// @throw std::invalid_argument names the contradiction in the message
core::evidence::Statistics fromMessage(const self_awareness::Evidence& message,
                                       const core::Vocabulary& vocabulary);
/// Gives an event type the partners of a message.
/// @throw std::invalid_argument names the contradiction in the message, or with the event types
void setPairs(const self_awareness::EvidencePairs& message,
              core::evidence::Statistics& statistics);

self_awareness::Track toMessage(const core::evidence::Track& track);
/// @throw std::invalid_argument if the message's channel does not exist
core::evidence::Track fromMessage(const self_awareness::Track& message);

/// What a recording of the training showed.
self_awareness::RecordingFindings toMessage(
    const core::evidence::LimitFinder::Recording& recording);
/// @param tracks, types numbers of the model's
/// @throw std::invalid_argument names the contradiction in the message
core::evidence::LimitFinder::Recording fromMessage(
    const self_awareness::RecordingFindings& message, std::size_t tracks, std::size_t types);

self_awareness::Relation toMessage(const core::evidence::Relation& relation);
/// @throw std::invalid_argument if its spread is no share
core::evidence::Relation fromMessage(const self_awareness::Relation& message);

}  // namespace self_awareness::ros1
