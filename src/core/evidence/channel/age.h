#pragma once

#include "core/evidence/channel/channel.h"

namespace self_awareness::core::evidence {

/// Age (docs/method.md, section 3.10): messages whose stamps are older than usual. Evidence is by
/// how much [s], of the last two messages the lesser.
class Age : public Channel {
 public:
  std::string name() const override { return "age"; }
  Finding finding() const override { return Finding::kUnusual; }
  Kind kind() const override { return Kind::kStale; }
  bool isOfAttributes() const override { return true; }
  std::vector<Track> watch(const Choice& choice) const override;
  std::unique_ptr<const Expectation> expect(const Model& model, const Halves& halves,
                                            std::vector<std::size_t> tracks) const override;
};

}  // namespace self_awareness::core::evidence
