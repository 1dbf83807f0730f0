#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/verdict/judge.h"
#include "self_awareness/core/verdict/source_graph.h"

namespace self_awareness::core::evidence {

/// Threshold of every judgement. The score is the largest evidence in units of its limit, with a
/// minus sign: as in eq. 5, low is abnormal (docs/method.md, section 4.1).
constexpr double kThreshold = -1;

/// What a window says in units of the limits: 1 is the limit. The largest of all is the score,
/// with a minus sign, unless the machine is busy (docs/method.md, section 4.1).
struct Shares {
  /// By track of the model; 0: no evidence, or not judged.
  const std::vector<double>& tracks;
  /// Of event types that should have come after the start (docs/method.md, section 3.8).
  std::vector<std::pair<EventId, double>> never_heard;
};
/// Called with every window that is judged; the shares are valid during the call.
using SharesHandler = std::function<void(const Window&, const Shares&)>;

/// Makes the judge of the evidence detector (docs/method.md, sections 3, 4.1 and 4.3): the largest
/// evidence in units of its limit decides over a window.
/// @param limits none: not calibrated, windows have no score and are never abnormal
/// @param window length [ns]
/// @param graph who is upstream of whom; shared, so it may grow meanwhile
/// @param heard event types by id, those of the model first, then those that it does not know;
/// shared, so it may grow meanwhile. None: of unknown events, only the number is known
/// @param shares told what each window says, if there are limits; none: nobody wants to know
/// @throw std::invalid_argument if the limits are not those of the model
std::unique_ptr<core::Judge> makeJudge(std::shared_ptr<const Model> model,
                                       std::optional<Limits> limits, std::int64_t window,
                                       std::shared_ptr<const SourceGraph> graph,
                                       std::shared_ptr<const Vocabulary> heard = nullptr,
                                       SharesHandler shares = nullptr);

}  // namespace self_awareness::core::evidence
