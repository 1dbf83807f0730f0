#pragma once

#include "core/evidence/channel/channel.h"

namespace self_awareness::core::evidence {

/// Lost (docs/method.md, section 3.10): numbers of messages that are missing. Evidence is a sum:
/// each loss adds to it, and each message that came takes from it.
class Lost : public Channel {
 public:
  std::string name() const override { return "lost"; }
  Finding finding() const override { return Finding::kUnusual; }
  Kind kind() const override { return Kind::kLossy; }
  bool isOfAttributes() const override { return true; }
  std::vector<Track> watch(const Choice& choice) const override;
  std::unique_ptr<const Expectation> expect(const Model& model, const Halves& halves,
                                            std::vector<std::size_t> tracks) const override;
};

}  // namespace self_awareness::core::evidence
