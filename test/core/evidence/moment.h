#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/evidence/explain/unusual.h"
#include "core/evidence/watch/upstream.h"
#include "self_awareness/core/verdict/source_graph.h"
#include "tracks.h"

/// A moment of a robot, as excuses and the explanation see it.
namespace self_awareness::core::evidence {

/// Every limit of silence is 1.
struct Moment {
  Moment(const std::shared_ptr<const Model>& model, std::shared_ptr<const SourceGraph> graph)
      : causes(model, std::make_shared<Upstream>(model->components(), std::move(graph))),
        limits_of_silence(model->size(), kNone),
        may_be_silent(model->size(), false) {
    for (std::size_t track = 0; track < model->tracks().size(); ++track) {
      if (model->finding(track) == Finding::kSilent) {
        limits_of_silence[model->tracks()[track].to] = 0.5;
      }
    }
  }
  Unusual in(const std::vector<Excess>& excesses, const Scorer& scorer,
             const RecentEvents& events) {
    causes.closeWindow(excesses);
    return {excesses, scorer, events, causes, limits_of_silence, strangers, may_be_silent};
  }

  Causes causes;
  std::vector<double> limits_of_silence;
  std::map<std::string, std::int64_t> strangers;
  std::vector<bool> may_be_silent;
};

}  // namespace self_awareness::core::evidence
