#include "core/evidence/channel/rate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "self_awareness/core/evidence/channel/model.h"

namespace self_awareness::core::evidence {
namespace {

class ExpectedRates : public Expectation {
 public:
  ExpectedRates(const Model& model, std::vector<std::size_t> tracks, double sign);

  std::unique_ptr<ChannelState> start() const override;
  double leastLimit(std::size_t /*track*/) const override { return least_limit_; }
  double ofSilence(std::size_t track, double age) const override {
    const EventId id = typeOf(track);
    const double heard = std::max(1 - age / static_cast<double>(kRateSpan), 0.0);
    return sign_ < 0 ? evidence(id, heard * rates_[id].mean) : 0;
  }
  double limit(std::size_t track, double /*largest*/, double most) const override {
    const bool reached = sign_ > 0 || most < evidence(typeOf(track), 0);
    return reached ? most : std::numeric_limits<double>::quiet_NaN();
  }

  /// How many spreads a count lies above the mean, or below it if the sign is -1: z of the
  /// section.
  double evidence(EventId id, double count) const {
    return sign_ * (count - rates_[id].mean) / rates_[id].spread;
  }
  /// The count that lies so many spreads above the mean.
  double usualCount(EventId id, double spreads) const {
    return rates_[id].mean + spreads * rates_[id].spread;
  }
  /// What is wrong with who is beyond the limit.
  Kind kind() const { return sign_ > 0 ? Kind::kFast : Kind::kSlow; }
  EventId typeOf(std::size_t track) const { return model_.tracks()[track].to; }

 private:
  struct OfType {
    double mean = 0;
    double spread = 1;
  };

  const Model& model_;
  double sign_;
  double least_limit_;
  std::vector<OfType> rates_;  // by id
};

class RateState : public ChannelState {
 public:
  explicit RateState(const ExpectedRates& expected) : expected_(expected) {}

  void closeWindow(const Heard& heard, std::vector<double>& evidence) override {
    for (const std::size_t track : expected_.tracks()) {
      const EventId id = expected_.typeOf(track);
      const std::optional<std::uint32_t> count = heard.rate(id);
      evidence[track] = count ? std::max(expected_.evidence(id, *count), 0.0) : 0;
    }
  }
  void explain(std::size_t /*track*/, const Heard& heard, const RecentEvents& /*events*/,
               Suspect& suspect) const override {
    const std::uint32_t count = heard.recentCount(suspect.id);
    const double fewest = std::max(expected_.usualCount(suspect.id, -2), 0.0);
    const double most = expected_.usualCount(suspect.id, 2);
    Reason& reason = suspect.reason;
    reason.kind = expected_.kind();
    reason.unit = unit::kHertz;
    reason.lasted = toSeconds(kRateSpan);
    reason.value = count / reason.lasted;
    reason.usual = expected_.usualCount(suspect.id, 0) / reason.lasted;
    reason.usual_shortest = fewest / reason.lasted;
    reason.usual_longest = most / reason.lasted;
    char text[80];
    std::snprintf(text, sizeof text, "%u in the last 2 s, usually %.0f to %.0f", count, fewest,
                  most);
    reason.words = text;
  }

 private:
  const ExpectedRates& expected_;
};

ExpectedRates::ExpectedRates(const Model& model, std::vector<std::size_t> tracks, double sign)
    : Expectation(std::move(tracks)),
      model_(model),
      sign_(sign),
      least_limit_(model.tuning().least_rate_limit) {
  const Statistics& learned = model.learned();
  const auto windows = static_cast<double>(std::max<std::uint64_t>(learned.rateWindows(), 1));
  for (EventId id = 0; id < model.size(); ++id) {
    const Statistics::Type& type = learned.type(id);
    OfType rate;
    rate.mean = static_cast<double>(type.rate_sum) / windows;
    const double variance =
        static_cast<double>(type.rate_squares) / windows - rate.mean * rate.mean;
    const double drift = model.tuning().least_rate_effect * rate.mean;
    // Counts that never varied may still vary by one.
    rate.spread =
        std::sqrt(std::max(variance, 0.0) + std::min(1.0, rate.mean / 4) + 0.25 + drift * drift);
    rates_.push_back(rate);
  }
}

std::unique_ptr<ChannelState> ExpectedRates::start() const {
  return std::make_unique<RateState>(*this);
}

}  // namespace

std::vector<Track> Rate::watch(const Choice& choice) const {
  std::vector<Track> tracks;
  for (EventId id = 0; id < choice.both.size(); ++id) {
    // Fewer events come in bursts, or when something happens.
    if (choice.isJudged(id) &&
        static_cast<double>(choice.both.type(id).rate_sum) >=
            choice.tuning.least_rate * static_cast<double>(choice.both.rateWindows())) {
      tracks.push_back({this, id, id});
    }
  }
  return tracks;
}

std::unique_ptr<const Expectation> Rate::expect(const Model& model, const Halves& /*halves*/,
                                                std::vector<std::size_t> tracks) const {
  return std::make_unique<ExpectedRates>(model, std::move(tracks),
                                         side_ == Side::kMore ? 1.0 : -1.0);
}

}  // namespace self_awareness::core::evidence
