#pragma once

#include <memory>
#include <optional>

#include "self_awareness/core/paper/model.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/verdict/judge.h"

namespace self_awareness::core::paper {

/// Makes the judge of the paper's detector: it compares the score of eq. 2 to 4 with the threshold
/// s* of eq. 5 (docs/method.md, section 2.2).
/// @param threshold s*; none: windows are scored and never abnormal
/// @param silence_is_abnormal true: a window without events scores 0; false: it has no score
/// @param heard event types by id, those of the model first; may grow. None: a mode of the robot
/// (stream/mode.h) that the model does not know is an unknown event
/// @throw std::invalid_argument if the threshold is not finite
std::unique_ptr<core::Judge> makeJudge(const std::shared_ptr<const Model>& model,
                                       std::optional<double> threshold, bool silence_is_abnormal,
                                       std::shared_ptr<const Vocabulary> heard = nullptr);

}  // namespace self_awareness::core::paper
