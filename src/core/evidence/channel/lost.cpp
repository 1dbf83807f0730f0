#include "core/evidence/channel/lost.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/evidence/channel/messages.h"

namespace self_awareness::core::evidence {
namespace {

// A source whose numbers do not count its messages has more that neither count on nor leave some
// out, or leaves more out.
constexpr double kMostOthers = 0.01;
constexpr double kMostLosses = 0.1;
// Fewer numbers do not say whether messages are lost.
constexpr double kFewestNumbers = 300;
// Twice what training lost is as usual as once.
constexpr double kTimesUsual = 2;
// A run without a loss is so improbable [nats], if losses go on as they were: they are over.
constexpr double kOver = 5;
// Losses so close together are chance where they come more often than that in an hour.
constexpr double kLostByChance = 0.001;
constexpr int kIterations = 50;  // far more than it takes

/// Share of the messages before which some are missing.
double shareOf(const AttributeCounts& counts) {
  const auto numbered = static_cast<double>(counts.numbered());
  return numbered > 0 ? static_cast<double>(counts.losses()) / numbered : 0;
}

/// Share of the messages that may be missing: half a loss more than training had, and no less than
/// of all sources together, since who lost less than the others was lucky.
double shareToExpect(const AttributeCounts& counts, double of_all) {
  return std::max(of_all, (static_cast<double>(counts.losses()) + 0.5) /
                              static_cast<double>(std::max<std::uint64_t>(counts.numbered(), 1)));
}

/// The sum that chance reaches kLostByChance times an hour at most. After a loss it is 1, and of
/// the random walk that follows, exp(-theta (x - 1)) is the bound for reaching x, where
/// share (exp(theta) - 1) = drift theta (Lundberg's inequality).
double sumBeyondChance(double share, double mean_gap, double drift) {
  const double an_hour = kNanosecondsPerHour / std::max(mean_gap, 1.0) * share;
  const double ratio = drift / share;  // 4 / 3 or more
  double theta = ratio;
  for (int k = 0; k < kIterations; ++k) {
    theta = std::log1p(ratio * theta);
  }
  return 1 + std::max(std::log(an_hour / kLostByChance), 0.0) / theta;
}

struct NumbersOfMessages {
  struct Usual {
    double least_limit = 0;
    bool is_supported = true;
    double share = 0;        // of the losses that training had
    double drift = 0;        // what each message takes from the sum
    std::int64_t pause = 0;  // a longer gap [ns]
  };

  void add(const Heard::Arrival& arrival, const Usual& usual, double most) {
    if (arrival.attributes.step == Attributes::Step::kNotKnown || arrival.stalled) {
      return;
    }
    const bool loss = arrival.attributes.isAfterLoss();
    if (!loss && arrival.stamp - arrival.last_stamp > usual.pause) {
      sum = 0;  // after a pause, what was lost before it is no news
    }
    if (sum <= 0) {
      losses = 0;
      messages = 0;
    }
    losses += loss ? 1 : 0;
    ++messages;
    since_loss = loss ? 0 : since_loss + 1;
    const bool over = static_cast<double>(losses) * since_loss > kOver * messages;
    sum = over ? 0 : std::clamp(sum + (loss ? 1 : 0) - usual.drift, 0.0, most);
  }
  double evidence() const { return sum; }
  void explain(const Usual& usual, Reason& reason) const {
    reason.kind = Kind::kLossy;
    reason.unit = "share";
    reason.value = messages > 0 ? static_cast<double>(losses) / messages : 0;
    reason.usual = usual.share;
    reason.usual_shortest = 0;
    reason.usual_longest = usual.drift;
    char text[120];
    std::snprintf(text, sizeof text,
                  "messages missing %u times among the last %u (%.1f %%), usually %.1f %%", losses,
                  messages, 100 * reason.value, 100 * usual.share);
    reason.words = text;
  }

  double sum = 0;
  std::uint32_t losses = 0;    // since the sum was 0
  std::uint32_t messages = 0;  // the same
  std::uint32_t since_loss = 0;
};

}  // namespace

std::vector<Track> Lost::watch(const Choice& choice) const {
  return tracksOfMessages(*this, choice, [&](EventId id) {
    const AttributeCounts& counts = choice.both.type(id).attributes;
    const auto next =
        static_cast<double>(counts.steps[static_cast<std::size_t>(Attributes::Step::kNext)]);
    const auto numbered = static_cast<double>(counts.numbered());
    const auto losses = static_cast<double>(counts.losses());
    return next >= kFewestNumbers && losses <= kMostLosses * numbered &&
           numbered - next - losses <= kMostOthers * numbered;
  });
}

std::unique_ptr<const Expectation> Lost::expect(const Model& model, const Halves& /*halves*/,
                                                std::vector<std::size_t> tracks) const {
  AttributeCounts all;
  for (const std::size_t track : tracks) {
    const AttributeCounts& counts = model.learned().type(model.tracks()[track].to).attributes;
    if (shareOf(counts) <= kMostOthers) {  // who loses more does so by itself
      all.merge(counts);
    }
  }
  return std::make_unique<ExpectedMessages<NumbersOfMessages>>(
      model, std::move(tracks), [&, of_all = shareOf(all)](EventId id) {
        const Tuning& tuning = model.tuning();
        const AttributeCounts& counts = model.learned().type(id).attributes;
        NumbersOfMessages::Usual usual;
        usual.pause = pauseOf(model, id);
        usual.share = shareOf(counts);
        usual.drift = std::max(tuning.usual_losses, kTimesUsual * std::max(usual.share, of_all));
        usual.least_limit = std::max(
            tuning.least_losses,
            sumBeyondChance(shareToExpect(counts, of_all), model.meanGap(id), usual.drift));
        return usual;
      });
}

}  // namespace self_awareness::core::evidence
