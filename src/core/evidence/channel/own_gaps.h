#pragma once

#include "core/evidence/channel/channel.h"

namespace self_awareness::core::evidence {

/// Own gaps (docs/method.md, section 3.5): an event type at unusual delays after itself. Evidence
/// is the sum of their surprises.
class OwnGaps : public Channel {
 public:
  std::string name() const override { return "own gaps"; }
  std::string label() const override { return "pairs"; }
  Finding finding() const override { return Finding::kUnusual; }
  Kind kind() const override { return Kind::kLate; }
  std::string about() const override { return "pace"; }
  std::string whyNot(const Statistics& /*counts*/, EventId /*id*/,
                     const Tuning& /*tuning*/) const override {
    return "it changed for long in normal operation";
  }
  std::vector<Track> watch(const Choice& choice) const override;
  std::unique_ptr<const Expectation> expect(const Model& model, const Halves& halves,
                                            std::vector<std::size_t> tracks) const override;
  Margins margins(const Tuning& tuning) const override {
    return {tuning.least_deadline_margin, tuning.least_deadline_margin};
  }
};

}  // namespace self_awareness::core::evidence
