#pragma once

#include "core/evidence/channel/channel.h"

namespace self_awareness::core::evidence {

/// Values (docs/method.md, section 3.11): a value of a type field that comes more often among the
/// messages of its sender on a topic than in training, as of goals that fail. Evidence is a CUSUM
/// of how much better they fit that.
class Values : public Channel {
 public:
  std::string name() const override { return "values"; }
  Finding finding() const override { return Finding::kUnusual; }
  Kind kind() const override { return Kind::kFast; }
  bool mayBeLate() const override { return false; }
  std::vector<Track> watch(const Choice& choice) const override;
  std::unique_ptr<const Expectation> expect(const Model& model, const Halves& halves,
                                            std::vector<std::size_t> tracks) const override;
};

}  // namespace self_awareness::core::evidence
