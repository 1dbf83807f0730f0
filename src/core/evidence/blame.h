#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/evidence/scorer.h"
#include "self_awareness/core/stream/windows.h"
#include "self_awareness/core/verdict/source_graph.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::evidence {

/// Names the event types that abnormal evidence may be blamed on. Who is silent comes first: the
/// source upstream of the others, then by how improbable so long a silence is. Where nobody is,
/// the source that is involved in most of what is unusual.
class Blame {
 public:
  /// @param graph may be empty: then the silences alone decide
  Blame(std::shared_ptr<const Model> model, std::shared_ptr<const SourceGraph> graph);

  /// @param shares of its limit that every track of the model has reached
  /// @param window that the scorer closed last
  /// @return at most kMostSuspects, the first the most likely, each event type once
  std::vector<Suspect> suspects(const std::vector<double>& shares, const Scorer& scorer,
                                const Window& window) const;

 private:
  struct Candidate {
    Suspect suspect;
    double rank = 0;  // the smaller, the more likely
  };

  static bool likelier(const Candidate& a, const Candidate& b) { return a.rank < b.rank; }
  std::vector<Candidate> rootFirst(std::vector<Candidate> candidates) const;
  std::vector<Candidate> silent(const std::vector<double>& shares, const Scorer& scorer) const;
  std::vector<Candidate> unusual(const std::vector<double>& shares, const Scorer& scorer) const;
  double logSurvival(EventId id, const Scorer& scorer) const;
  Suspect silence(EventId id, const Scorer& scorer) const;
  Suspect unusualTrack(std::size_t track, const Scorer& scorer) const;
  const std::string& component(EventId id) const;

  std::shared_ptr<const Model> model_;
  std::shared_ptr<const SourceGraph> graph_;
};

}  // namespace self_awareness::core::evidence
