#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/evidence/hindsight.h"
#include "core/evidence/reasons.h"
#include "core/evidence/scorer.h"
#include "self_awareness/core/stream/windows.h"
#include "self_awareness/core/verdict/source_graph.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::evidence {

/// Names the event types that may have caused abnormal evidence (docs/method.md, section 6).
/// Silent ones come first, a source upstream of the others before them, then the least probable
/// silence. If none is silent, the source comes first that most of what is unusual involves.
class Blame {
 public:
  /// @param graph may be empty: the silences alone then decide
  Blame(std::shared_ptr<const Model> model, std::shared_ptr<const SourceGraph> graph);

  /// @param shares of their limits that the tracks of the model have reached
  /// @param hindsight of the scorer's recording
  /// @param window that the scorer closed last
  /// @return at most kMostSuspects, the most likely first, each event type once; after them, of
  /// each further component whose evidence alone is abnormal the most likely event type
  std::vector<Suspect> suspects(const std::vector<double>& shares, const Scorer& scorer,
                                const Hindsight& hindsight, const Window& window) const;

 private:
  struct Candidate {
    std::size_t track = 0;  // that speaks against its `to`
    double rank = 0;        // the smaller, the more likely
  };

  static bool likelier(const Candidate& a, const Candidate& b) { return a.rank < b.rank; }
  std::vector<Candidate> rootFirst(std::vector<Candidate> candidates) const;
  std::vector<Candidate> silent(const std::vector<double>& shares, const Reasons& reasons) const;
  std::vector<Candidate> unusual(const std::vector<double>& shares, const Reasons& reasons) const;
  double logSurvival(EventId id, const Reasons& reasons) const;
  std::size_t trackOfSilence(EventId id, const std::vector<double>& shares) const;
  EventId toOf(const Candidate& candidate) const { return model_->tracks()[candidate.track].to; }
  const std::string& component(EventId id) const;

  std::shared_ptr<const Model> model_;
  std::shared_ptr<const SourceGraph> graph_;
};

}  // namespace self_awareness::core::evidence
