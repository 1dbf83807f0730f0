#pragma once

#include "core/evidence/channel/channel.h"

namespace self_awareness::core::evidence {

/// Company (docs/method.md, section 3.5): `to` and `from` pause together, as everything does that
/// a robot needs in one of its modes only. While `from` goes on, `to` may not pause. Evidence is
/// the number of `from` since the last `to`. A mode of the robot that is told goes on while it
/// lasts: it counts as often as it ticks (stream/mode.h).
class Company : public Channel {
 public:
  std::string name() const override { return "company"; }
  Finding finding() const override { return Finding::kAbsent; }
  Kind kind() const override { return Kind::kSilent; }
  bool mayBeLate() const override { return false; }
  std::vector<Track> watch(const Choice& choice) const override;
  std::unique_ptr<const Expectation> expect(const Model& model, const Halves& /*halves*/,
                                            std::vector<std::size_t> tracks) const override;
};

}  // namespace self_awareness::core::evidence
