#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "self_awareness/core/evidence/model.h"
#include "self_awareness/core/verdict/judge.h"
#include "self_awareness/core/verdict/source_graph.h"

namespace self_awareness::core::evidence {

/// The threshold of every judgement: the score is the largest evidence in units of its limit,
/// negative, so that as in eq. 5 low is abnormal.
constexpr double kThreshold = -1;

/// The evidence detector (docs/method.md, section 4.1): the largest evidence in units of its limit
/// decides over a window, and the linker, apart, over the last tens of seconds.
/// @param limits none: not calibrated, windows have no score and are never abnormal
/// @param window length [ns]
/// @param graph who is upstream of whom; shared, so that it can grow meanwhile
/// @throw std::invalid_argument if the limits are not those of the model
std::unique_ptr<core::Judge> makeJudge(std::shared_ptr<const Model> model,
                                       std::optional<Limits> limits, std::int64_t window,
                                       std::shared_ptr<const SourceGraph> graph);

}  // namespace self_awareness::core::evidence
