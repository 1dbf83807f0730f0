#pragma once

#include "core/evidence/channel/channel.h"

namespace self_awareness::core::evidence {

/// Frozen (docs/method.md, section 3.10): messages with the same bytes again and again. Evidence
/// is for how long [s].
class Frozen : public Channel {
 public:
  std::string name() const override { return "frozen"; }
  Finding finding() const override { return Finding::kUnusual; }
  Kind kind() const override { return Kind::kStuck; }
  bool isOfAttributes() const override { return true; }
  std::string about() const override { return "content"; }
  std::string whyNot(const Statistics& counts, EventId id, const Tuning& tuning) const override;
  std::vector<Track> watch(const Choice& choice) const override;
  std::unique_ptr<const Expectation> expect(const Model& model, const Halves& halves,
                                            std::vector<std::size_t> tracks) const override;
};

}  // namespace self_awareness::core::evidence
