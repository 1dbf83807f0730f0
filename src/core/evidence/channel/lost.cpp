#include "core/evidence/channel/lost.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/evidence/channel/messages.h"
#include "core/evidence/channel/sum.h"

namespace self_awareness::core::evidence {
namespace {

/// Share of the messages that may be missing: half a loss more than training had, and no less than
/// of all sources together, since who lost less than the others was lucky.
double shareToExpect(const AttributeCounts& counts, double of_all) {
  return std::max(of_all, (static_cast<double>(counts.losses()) + 0.5) /
                              static_cast<double>(std::max<std::uint64_t>(counts.numbered(), 1)));
}

struct NumbersOfMessages {
  struct Usual {
    double least_limit = 0;
    bool is_supported = true;
    double share = 0;        // of the losses that training had
    double more = 0;         // what a loss adds to the sum [nat]
    double less = 0;         // what a message takes that follows the one before it [nat]
    double over = 0;         // a run without a loss that says so much ends the losses [nat]
    std::int64_t pause = 0;  // a longer gap [ns]
  };

  void add(const Heard::Arrival& arrival, const Usual& usual, double most) {
    if (arrival.attributes.step == Attributes::Step::kNotKnown || arrival.stalled) {
      return;
    }
    const bool loss = arrival.attributes.isAfterLoss();
    if (!loss && arrival.stamp - arrival.last_stamp > usual.pause) {
      sum.value = 0;  // after a pause, what was lost before it is no news
    }
    sum.cap = most;
    sum.count(loss, usual.more, arrival.stamp, usual.less);
    since_loss = loss ? 0 : since_loss + 1;
    // So long a run is improbable if losses go on as they were.
    if (static_cast<double>(sum.unusual) * since_loss > usual.over * sum.events) {
      sum.value = 0;
    }
  }
  double evidence() const { return sum.value; }
  void explain(const Usual& usual, Reason& reason) const {
    reason.kind = Kind::kLossy;
    reason.unit = "share";
    reason.value = sum.events > 0 ? static_cast<double>(sum.unusual) / sum.events : 0;
    reason.usual = usual.share;
    reason.usual_shortest = 0;
    reason.usual_longest = usual.share;
    char text[120];
    std::snprintf(text, sizeof text,
                  "messages missing %u times among the last %u (%.1f %%), usually %.1f %%",
                  sum.unusual, sum.events, 100 * reason.value, 100 * usual.share);
    reason.words = text;
  }

  CountedSum sum;  // of messages; unusual: before them, some are missing
  std::uint32_t since_loss = 0;
};

}  // namespace

std::vector<Track> Lost::watch(const Choice& choice) const {
  return tracksOfMessages(*this, choice, [&](EventId id) {
    const AttributeCounts& counts = choice.both.type(id).attributes;
    const std::uint64_t next = counts.steps[static_cast<std::size_t>(Attributes::Step::kNext)];
    const auto numbered = static_cast<double>(counts.numbered());
    const auto losses = static_cast<double>(counts.losses());
    // A source whose numbers do not count its messages has more that neither count on nor leave
    // some out, or leaves more out.
    return choice.tuning.areEnough(next) && losses <= (1 - choice.tuning.usual) * numbered &&
           numbered - static_cast<double>(next) - losses <= choice.tuning.rare * numbered;
  });
}

std::unique_ptr<const Expectation> Lost::expect(const Model& model, const Halves& /*halves*/,
                                                std::vector<std::size_t> tracks) const {
  return std::make_unique<ExpectedMessages<NumbersOfMessages>>(
      model, std::move(tracks), [&, of_all = model.shareOfLosses()](EventId id) {
        const Tuning& tuning = model.tuning();
        const AttributeCounts& counts = model.learned().type(id).attributes;
        NumbersOfMessages::Usual usual;
        usual.pause = pauseOf(model, id);
        usual.share = counts.shareOfLosses();
        const double expected = shareToExpect(counts, of_all);
        const double told =
            std::min(std::max(tuning.rare / 2, tuning.several * expected), tuning.most_unusual);
        usual.more = std::min(std::log(told / expected), tuning.least_sum / 2);
        usual.less = std::log((1 - expected) / (1 - told));
        usual.over = tuning.least_sum / 2;
        usual.least_limit =
            leastLimitOfSum(told * kNanosecondsPerHour / std::max(model.meanGap(id), 1.0), tuning);
        return usual;
      });
}

}  // namespace self_awareness::core::evidence
