#include "core/evidence/watch/silent_pairs.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "core/evidence/watch/gain.h"
#include "core/evidence/watch/relations.h"

namespace self_awareness::core::evidence {
namespace {

/// Both halves together, with no pair but the gaps of each type.
Statistics ownGaps(const Halves& counts) {
  Statistics both;
  for (const Statistics& half : counts) {
    Statistics own = half.withoutPairs();
    for (EventId id = 0; id < half.size(); ++id) {
      if (const std::optional<std::size_t> place = half.partners(id).find(id)) {
        Partners gaps;
        gaps.append(half.partners(id).at(*place));
        own.setPartners(id, std::move(gaps));
      }
    }
    both.merge(own);
  }
  return both;
}

/// What the delays from one type to another say.
class Says {
 public:
  /// The counts and the tuning must outlive this.
  Says(const Halves& counts, const Tuning& tuning)
      : counts_(counts),
        tuning_(tuning),
        gain_(counts[0], counts[1], tuning.fewest_gaps),
        other_gain_(counts[1], counts[0], tuning.fewest_gaps) {}

  /// Whether enough is known of them, and it is less than a pair must say.
  bool little(EventId from, EventId to) const {
    const std::uint64_t fewer = std::min(counts_[0].total(from, to), counts_[1].total(from, to));
    return static_cast<double>(fewer) >= tuning_.fewest_gaps &&
           gain_.most(from, to) + other_gain_.most(from, to) < 2 * tuning_.least_gain;
  }
  /// Whether there are enough of them to be watched.
  bool areEnough(EventId from, EventId to) const {
    return tuning_.areEnough(counts_[0].total(from, to) + counts_[1].total(from, to));
  }

 private:
  const Halves& counts_;
  const Tuning& tuning_;
  InformationGain gain_;
  InformationGain other_gain_;
};

}  // namespace

PairSet silentPairs(const Halves& counts, const SourceGraph& graph, const Tuning& tuning) {
  const Statistics own = ownGaps(counts);
  const Relations relations(own, graph, tuning);
  const Says says(counts, tuning);
  const auto isKnown = [&](EventId id) {
    return static_cast<double>(own.type(id).gaps) >= tuning.fewest_gaps &&
           !own.vocabulary().tellsMode(id);  // company needs all pairs with a mode
  };
  const auto mayBeOwed = [&](EventId from, EventId to) {
    return relations.mayBeOwed(from, to,
                               counts[0].answers(from, to) + counts[1].answers(from, to));
  };
  PairSet silent;
  for (EventId a = 0; a < own.size(); ++a) {
    for (EventId b = 0; b < a && isKnown(a); ++b) {
      if (!isKnown(b)) {
        continue;
      }
      const bool little = says.little(a, b);
      const bool little_back = says.little(b, a);
      // What may be watched is kept in both orders.
      const bool leave = little && (little_back || !says.areEnough(b, a));
      const bool leave_back = little_back && (little || !says.areEnough(a, b));
      if ((!leave && !leave_back) || mayBeOwed(a, b) || mayBeOwed(b, a)) {
        continue;
      }
      if (leave) {
        silent.add(b, a);
      }
      if (leave_back) {
        silent.add(a, b);
      }
    }
  }
  return silent;
}

void leaveOutSilentPairs(Halves& counts, const SourceGraph& graph, const Tuning& tuning) {
  if (counts[0].size() <= kMostTypesOfAllPairs) {
    return;
  }
  const PairSet silent = silentPairs(counts, graph, tuning);
  for (Statistics& half : counts) {
    half = half.without(silent);
  }
}

}  // namespace self_awareness::core::evidence
