#pragma once

#include <cstddef>
#include <vector>

#include "self_awareness/Calibration.h"
#include "self_awareness/EvidenceCalibration.h"
#include "self_awareness/Recording.h"
#include "self_awareness/core/model.h"

namespace self_awareness::ros1 {

std::vector<self_awareness::Recording> toMessages(
    const std::vector<core::RecordingInfo>& recordings);
std::vector<core::RecordingInfo> fromMessages(
    const std::vector<self_awareness::Recording>& messages);

self_awareness::EvidenceCalibration toMessage(const core::Calibration& calibration);
/// @param tracks, types numbers of the model's
/// @throw std::invalid_argument names what cannot be, or does not fit the model
core::Calibration fromMessage(const self_awareness::EvidenceCalibration& message,
                              std::size_t tracks, std::size_t types);

self_awareness::Calibration toMessage(const core::paper::Calibration& calibration);
/// @throw std::invalid_argument names what cannot be
core::paper::Calibration fromMessage(const self_awareness::Calibration& message);

}  // namespace self_awareness::ros1
