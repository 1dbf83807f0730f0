#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "core/evidence/count/starts.h"
#include "self_awareness/core/evidence/count/statistics.h"
#include "self_awareness/core/evidence/tuning.h"
#include "self_awareness/core/evidence/watch/relation.h"
#include "self_awareness/core/verdict/source_graph.h"

namespace self_awareness::core::evidence {

/// Says of two event types whether what they do together has a reason, or may be chance
/// (docs/method.md, section 3.6). Two timers that have nothing to do with each other keep one
/// phase for as long as they run, and so look like question and answer within a start.
class Relations {
 public:
  /// @param counts of the whole training, at least of the pairs that are asked for; must outlive
  /// the relations, and so must the graph and the tuning
  Relations(const Statistics& counts, const SourceGraph& graph, const Tuning& tuning);

  /// Reasons to watch the delays from `from` to `to`.
  /// @param more recordings that were not trained on, in which the delays were as in training
  Relation delays(EventId from, EventId to, const std::vector<Span>& more = {}) const;
  /// Reasons to watch whether `to` comes in time after `from` asks for it: that it comes says more
  /// than what `to` does at any time.
  Relation owed(EventId from, EventId to) const;
  /// Whether more recordings may show that it is owed: it may be chance in one of the many pairs,
  /// but hardly in this one alone.
  /// @param answers gaps of `from` in which a `to` came
  bool mayBeOwed(EventId from, EventId to, std::uint64_t answers) const;

  /// Whether it is known who hears whom.
  bool knowGraph() const { return !graph_.empty(); }
  /// Number of ordered pairs of event types with enough gaps; 1 if there are none.
  double lookedAt() const { return looked_at_; }
  /// Share of the gaps of `from` in which no `to` would come if they had nothing to do with each
  /// other, 0 to 1.
  double missRateByChance(EventId from, EventId to) const;

 private:
  struct Gap {
    double length = 0;  // [ns]
    double share = 0;   // of the gaps
  };

  /// Requests and their answers.
  struct Asked {
    bool reaches = false;
    bool beyond_chance = false;  // fewer misses than if they had nothing to do with each other
    double divergence = 0;       // from that [nat]
  };

  Asked asked(EventId from, EventId to, std::uint64_t answers) const;
  bool reaches(EventId from, EventId to) const;
  bool isIrregular(EventId from, EventId to) const;
  double meanGap(EventId id) const { return counts_.type(id).meanGap(); }  // [ns]
  /// The shorter of the two mean gaps [ns].
  double period(EventId from, EventId to) const;
  double medianDelay(EventId from, EventId to) const;  // [ns]
  /// Whether one comes in the second half of a period after another: it may as well be the one
  /// that asks, and of what one node publishes, nobody knows what comes upon what.
  bool isLate(EventId from, EventId to) const;
  bool areOfOneSource(EventId from, EventId to) const;
  /// Share of a period that the delays lie in, in all starts together, 0 to 1.
  /// @param left_out share of the delays that may lie elsewhere
  double spread(EventId from, EventId to, double left_out) const;

  const Statistics& counts_;
  const SourceGraph& graph_;
  const Tuning& tuning_;
  std::set<std::string> broadcasts_;    // topics that everybody hears
  double looked_at_ = 1;                // number of pairs
  std::vector<std::vector<Gap>> gaps_;  // by id
  std::vector<double> cut_off_;         // heads and tails that count [ns], by id
};

/// Share of the gaps of an event type in which another did not answer, above 0 and below 1: p of
/// docs/method.md, section 3.4.
double missRate(std::uint64_t gaps, std::uint64_t answers);

}  // namespace self_awareness::core::evidence
