#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "self_awareness/core/evidence/model.h"
#include "self_awareness/core/verdict/judge.h"
#include "self_awareness/core/verdict/source_graph.h"

namespace self_awareness::core::evidence {

/// Threshold of every judgement. The score is the largest evidence in units of its limit, with a
/// minus sign: as in eq. 5, low is abnormal (docs/method.md, section 4.1).
constexpr double kThreshold = -1;

/// Makes the judge of the evidence detector (docs/method.md, sections 3, 4.1 and 4.3): the largest
/// evidence in units of its limit decides over a window; the linker decides over the last tens of
/// seconds.
/// @param limits none: not calibrated, windows have no score and are never abnormal
/// @param window length [ns]
/// @param graph who is upstream of whom; shared, so it may grow meanwhile
/// @param heard event types by id, those of the model first, then those that it does not know;
/// shared, so it may grow meanwhile. None: of unknown events, only the number is known
/// @throw std::invalid_argument if the limits are not those of the model
std::unique_ptr<core::Judge> makeJudge(std::shared_ptr<const Model> model,
                                       std::optional<Limits> limits, std::int64_t window,
                                       std::shared_ptr<const SourceGraph> graph,
                                       std::shared_ptr<const Vocabulary> heard = nullptr);

}  // namespace self_awareness::core::evidence
