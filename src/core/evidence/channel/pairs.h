#pragma once

#include "core/evidence/channel/channel.h"

namespace self_awareness::core::evidence {

/// Pairs (docs/method.md, section 3.5): an event type at unusual delays after another one.
/// Evidence is the sum of their surprises.
class Pairs : public Channel {
 public:
  std::string name() const override { return "pairs"; }
  Finding finding() const override { return Finding::kBetween; }
  Kind kind() const override { return Kind::kLate; }
  std::vector<Track> watch(const Choice& choice) const override;
  std::unique_ptr<const Expectation> expect(const Model& model, const Halves& halves,
                                            std::vector<std::size_t> tracks) const override;
  Relation reason(const Track& track, const Relations& relations,
                  const std::vector<Span>& as_usual) const override {
    return relations.delays(track.from, track.to, as_usual);
  }
  bool mayMislead() const override { return true; }
};

}  // namespace self_awareness::core::evidence
