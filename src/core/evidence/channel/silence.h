#pragma once

#include "core/evidence/channel/channel.h"

namespace self_awareness::core::evidence {

/// Overdue (docs/method.md, section 3.2): an event type that should have come by now. Evidence is
/// the time since the last one [s].
class Silence : public Channel {
 public:
  std::string name() const override { return "overdue"; }
  Finding finding() const override { return Finding::kSilent; }
  Kind kind() const override { return Kind::kSilent; }
  std::vector<Track> watch(const Choice& choice) const override;
  std::unique_ptr<const Expectation> expect(const Model& model, const Halves& /*halves*/,
                                            std::vector<std::size_t> tracks) const override;
};

}  // namespace self_awareness::core::evidence
