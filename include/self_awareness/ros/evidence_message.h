#pragma once

#include "self_awareness/Evidence.h"
#include "self_awareness/EvidenceCalibration.h"
#include "self_awareness/core/evidence_model.h"
#include "self_awareness/core/evidence_statistics.h"

namespace self_awareness::ros1 {

/// @param vocabulary whose ids the message uses; holds all event types of the statistics
self_awareness::Evidence toMessage(const core::EvidenceStatistics& statistics,
                                   const core::Vocabulary& vocabulary);
/// @throw std::invalid_argument says what in the message contradicts itself
core::EvidenceStatistics fromMessage(const self_awareness::Evidence& message,
                                     const core::Vocabulary& vocabulary);

core::EvidenceLimits limitsOf(const self_awareness::EvidenceCalibration& message);

}  // namespace self_awareness::ros1
