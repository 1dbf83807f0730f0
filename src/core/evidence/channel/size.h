#pragma once

#include "core/evidence/channel/channel.h"

namespace self_awareness::core::evidence {

/// Size (docs/method.md, section 3.10): messages that are smaller or larger than all in training.
/// Evidence is by how many octaves, of the last three messages the least.
class Size : public Channel {
 public:
  std::string name() const override { return "size"; }
  Finding finding() const override { return Finding::kUnusual; }
  Kind kind() const override { return Kind::kOtherSize; }
  bool isOfAttributes() const override { return true; }
  std::vector<Track> watch(const Choice& choice) const override;
  std::unique_ptr<const Expectation> expect(const Model& model, const Halves& halves,
                                            std::vector<std::size_t> tracks) const override;
};

}  // namespace self_awareness::core::evidence
