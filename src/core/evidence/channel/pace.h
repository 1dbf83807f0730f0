#pragma once

#include "core/evidence/channel/channel.h"

namespace self_awareness::core::evidence {

/// Pace (docs/method.md, section 3.3): an event type comes more seldom, or more often, than in
/// training. Evidence is a CUSUM of how much better its gaps fit that than what is usual.
class Pace : public Channel {
 public:
  enum class Side { kSlower, kFaster };

  explicit Pace(Side side) : side_(side) {}

  std::string name() const override { return side_ == Side::kSlower ? "slower" : "faster"; }
  std::string label() const override { return "pace"; }
  Finding finding() const override {
    return side_ == Side::kSlower ? Finding::kFewer : Finding::kUnusual;
  }
  Kind kind() const override { return side_ == Side::kSlower ? Kind::kSlow : Kind::kFast; }
  std::string about() const override {
    return side_ == Side::kSlower ? "slower pace" : "faster pace";
  }
  std::string whyNot(const Statistics& /*counts*/, EventId /*id*/,
                     const Tuning& /*tuning*/) const override {
    return "it changed for long in normal operation";
  }
  std::vector<Track> watch(const Choice& choice) const override;
  std::unique_ptr<const Expectation> expect(const Model& model, const Halves& halves,
                                            std::vector<std::size_t> tracks) const override;

 private:
  Side side_;
};

}  // namespace self_awareness::core::evidence
