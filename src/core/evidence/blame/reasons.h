#pragma once

#include <cstddef>

#include "core/evidence/blame/hindsight.h"
#include "core/evidence/channel/scorer.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::evidence {

/// Says why an event type is a suspect: the numbers of the track that speaks against it, now and
/// in training (docs/method.md, section 6).
class Reasons {
 public:
  /// @param scorer, hindsight of the same recording, and at the end of the same window; both must
  /// outlive this
  Reasons(const Scorer& scorer, const Hindsight& hindsight)
      : model_(scorer.model()), scorer_(scorer), hindsight_(hindsight) {}

  /// Time since the last event of a type at the end of the window [ns].
  std::int64_t age(EventId id) const;
  /// The event type that a track of the model watches, as a suspect; Blame says the rest.
  Suspect of(std::size_t track) const;

 private:
  void silence(Suspect& suspect) const;
  void rate(Suspect& suspect) const;
  void delay(std::size_t track, Suspect& suspect) const;
  void answer(std::size_t track, Suspect& suspect) const;
  double secondsSince(std::int64_t stamp) const;

  const Model& model_;
  const Scorer& scorer_;
  const Hindsight& hindsight_;
};

}  // namespace self_awareness::core::evidence
