#pragma once

#include "core/evidence/channel/channel.h"

namespace self_awareness::core::evidence {

/// Owed answers (docs/method.md, section 3.4): the `to` that `from` asks for does not come in
/// time. Evidence is the time since the first request without an answer [s], or, where requests
/// come in series, or answers fail now and then, the sum of what requests without one say [nat].
class Owed : public Channel {
 public:
  std::string name() const override { return "deadlines"; }
  Finding finding() const override { return Finding::kUnanswered; }
  Kind kind() const override { return Kind::kSilent; }
  std::vector<Track> watch(const Choice& choice) const override;
  std::unique_ptr<const Expectation> expect(const Model& model, const Halves& /*halves*/,
                                            std::vector<std::size_t> tracks) const override;
  Relation reason(const Track& track, const Relations& relations,
                  const std::vector<Span>& /*as_usual*/) const override {
    return relations.owed(track.from, track.to);
  }
};

}  // namespace self_awareness::core::evidence
