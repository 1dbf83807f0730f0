#include "core/evidence/channel/rate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "channel_case.h"

namespace self_awareness::core::evidence {
namespace {

// Counts with the recent counts of one event type.
Statistics ofRate(std::uint64_t sum, std::uint64_t squares, std::uint64_t windows) {
  Statistics counts;
  counts.intern(kTypes[kA]);
  counts.type(kA).rate_sum = sum;
  counts.type(kA).rate_squares = squares;
  counts.addRateWindows(windows);
  return counts;
}

// What both channels say of so many events in the last kRateSpan: above 0 are too many, below 0
// too few.
class Rates {
 public:
  explicit Rates(const Statistics& first, const Statistics& second = {})
      : model_({{trackOf(kMore, kA, kA), trackOf(kFewer, kA, kA)}, {first, second}, {}}) {}

  double of(int number) const {
    Heard heard(1, kWindow, Stalls(100 * kSecond, 0, model_.tuning()), model_.tuning());
    const auto add = [&](std::int64_t stamp) { heard.end(heard.begin({stamp, kA})); };
    add(0);
    std::int64_t end = 0;
    for (; end < kRateSpan; end += kWindow) {
      heard.closeWindow(end);
    }
    for (int k = 0; k < number; ++k) {
      add(end);
    }
    heard.closeWindow(end);
    EXPECT_EQ(heard.rate(kA), static_cast<std::uint32_t>(number));
    std::vector<double> evidence(2, -1);
    for (const auto& expectation : model_.expectations()) {
      expectation->start()->closeWindow(heard, evidence);
    }
    EXPECT_EQ(std::min(evidence[0], evidence[1]), 0) << "one of them says nothing";
    return evidence[0] - evidence[1];
  }

 private:
  Model model_;
};

TEST(Rate, IsTheNumberOfSpreadsAboveTheMean) {
  // Mean 4, variance 1; min(1, 4 / 4) + 1/4 more, and 4 % of the mean.
  const double spread = std::sqrt(1 + 1 + 0.25 + 0.16 * 0.16);
  const Rates often(ofRate(40, 170, 10));
  EXPECT_NEAR(often.of(7), 3 / spread, 1e-12);
  EXPECT_NEAR(often.of(1), -3 / spread, 1e-12);
  // Mean 0.4, variance 0.24, min(1, 0.1) + 1/4 more.
  EXPECT_NEAR(Rates(ofRate(4, 4, 10)).of(1), 0.6 / std::sqrt(0.59 + 0.016 * 0.016), 1e-12);
  // The halves add up.
  EXPECT_NEAR(Rates(ofRate(10, 45, 3), ofRate(30, 125, 7)).of(7), 3 / spread, 1e-12);
}

TEST(Rate, ThatWandersByAFewPercentIsNoFault) {
  // 1000 in 2 s, always the same in training: 5 % less is hardly unusual, a fifth less is.
  const Rates rates(ofRate(10000, 10000000, 10));
  EXPECT_GT(rates.of(950), -2);
  EXPECT_LT(rates.of(800), -4);
}

class RateTest : public FollowedTest {
 protected:
  std::size_t fewer_ = track(kFewer, kA, kA);
  std::size_t more_ = track(kMore, kA, kA);
};

TEST_F(RateTest, IsJudgedOnceTheSpanIsFull) {
  const std::size_t unseen = track(kFewer, kB, kB);
  for (int window = 1; window <= 40; ++window) {
    for (int i = 0; i < (window <= 20 ? 10 : 0); ++i) {
      add({now_, kA});
    }
    const std::vector<double>& evidence = scorer_.closeWindow(now_ += kWindow);
    EXPECT_EQ(evidence[unseen], 0);
    if (window < 20) {
      EXPECT_EQ(evidence[more_], 0) << window;
    } else if (window == 20) {
      EXPECT_EQ(scorer_.heard().recentCount(kA), 200U);
      EXPECT_GT(evidence[more_], 3);
      EXPECT_EQ(evidence[fewer_], 0);
    }
  }
  const std::vector<double>& evidence = scorer_.closeWindow(now_);
  EXPECT_GT(evidence[fewer_], 0);
  EXPECT_EQ(evidence[more_], 0);
}

TEST_F(RateTest, ASuspectIsToldOfByItsNumber) {
  askUsually(20);
  for (int i = 0; i < 300; ++i) {
    add({now_, kA});
  }
  now_ += kWindow;
  const Suspect often = suspect(more_);
  EXPECT_EQ(often.reason.kind, Kind::kFast);
  EXPECT_EQ(often.reason.unit, unit::kHertz);
  const std::uint32_t count = scorer_.heard().recentCount(kA);
  EXPECT_DOUBLE_EQ(often.reason.value, count / 2.0);
  EXPECT_DOUBLE_EQ(often.reason.lasted, 2);
  char text[80];
  std::snprintf(text, sizeof text, "%u in the last 2 s, usually %.0f to %.0f", count,
                2 * often.reason.usual_shortest, 2 * often.reason.usual_longest);
  EXPECT_EQ(often.reason.words, text);
  EXPECT_GT(often.reason.usual_shortest, 0);
  EXPECT_LT(often.reason.usual_shortest, 5);
  EXPECT_GT(often.reason.usual_longest, 5);
  EXPECT_LT(often.reason.usual_longest, 15);
}

}  // namespace
}  // namespace self_awareness::core::evidence
