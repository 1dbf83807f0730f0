#pragma once

#include "core/evidence/channel/channel.h"

namespace self_awareness::core::evidence {

/// Rate (docs/method.md, section 3.3): too few or too many events of a type in the last kRateSpan.
/// Evidence is how many spreads their number lies below or above the mean of training.
class Rate : public Channel {
 public:
  enum class Side { kFewer, kMore };

  explicit Rate(Side side) : side_(side) {}

  std::string name() const override { return side_ == Side::kFewer ? "fewer" : "more"; }
  std::string label() const override { return "rate"; }
  Finding finding() const override {
    return side_ == Side::kFewer ? Finding::kFewer : Finding::kUnusual;
  }
  Kind kind() const override { return side_ == Side::kFewer ? Kind::kSlow : Kind::kFast; }
  std::int64_t looksBack() const override { return kRateSpan; }
  std::vector<Track> watch(const Choice& choice) const override;
  std::unique_ptr<const Expectation> expect(const Model& model, const Halves& /*halves*/,
                                            std::vector<std::size_t> tracks) const override;

 private:
  Side side_;
};

}  // namespace self_awareness::core::evidence
