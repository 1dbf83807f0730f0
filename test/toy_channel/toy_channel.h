#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/evidence/channel/channel.h"

namespace self_awareness::core::evidence {

/// A channel that is no part of the method: it shows what one needs (docs/developers.md). An
/// event type that comes in bursts. Evidence is the number of its events in one window.
class Bursts : public Channel {
 public:
  std::string name() const override { return "bursts"; }
  Finding finding() const override { return Finding::kUnusual; }
  Kind kind() const override { return Kind::kFast; }
  std::vector<Track> watch(const Choice& choice) const override;
  std::unique_ptr<const Expectation> expect(const Model& model, const Halves& halves,
                                            std::vector<std::size_t> tracks) const override;
};

}  // namespace self_awareness::core::evidence
