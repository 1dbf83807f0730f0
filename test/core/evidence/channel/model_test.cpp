#include "self_awareness/core/evidence/channel/model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <stdexcept>

#include "../tracks.h"
#include "self_awareness/core/evidence/limits/cross_fit.h"

namespace self_awareness::core::evidence {
namespace {

const Statistics kNothing = countsOf({});

TEST(EvidenceModel, RefusesWhatItCannotJudgeBy) {
  EXPECT_THROW(Model(watch({}, {})), std::invalid_argument) << "no event";
  Watched watched = watch(startOf(followed(1), 1), startOf(followed(2), 2));
  watched.tuning.least_effect = -1e-9;
  EXPECT_THROW(Model{watched}, std::invalid_argument);
  watched.tuning = {};
  EXPECT_NO_THROW(Model{watched});
  watched.tracks.push_back({nullptr, kA, kA});
  EXPECT_THROW(Model{watched}, std::invalid_argument) << "a track of no channel";
}

TEST(EvidenceModel, KnowsTheLongestGapsAndTheLongestTimeWithoutAnyEvent) {
  const Model model(
      watch(countsOf({{{0, kA}, {kSecond, kB}, {2 * kSecond, kB}}}),
            countsOf({later({{0, kB}, {250, kB}, {6 * kSecond, kC}, {8 * kSecond, kC}})})));
  EXPECT_EQ(model.logSurvival(kA, 3600 * kSecond), 0) << "it never repeated";
  EXPECT_EQ(model.longestGap(kA), 0);
  EXPECT_EQ(model.longestGap(kB), kSecond);
  EXPECT_EQ(model.longestSilence(), 2 * kSecond) << "but for the first seconds";
  EXPECT_TRUE(model.tracks().empty());
  EXPECT_EQ(Model(watch(countsOf({}), kNothing)).longestSilence(), 0);
}

TEST(EvidenceModel, SurvivalIsTheShareOfGapsAndATailBeyondThem) {
  const Model model(
      watch(countsOf({timer(kA, 0, 10 * kSecond + 1, 100 * kMillisecond)}), kNothing));
  EXPECT_NEAR(model.logSurvival(kA, 200 * kMillisecond), -2 - std::log(101), 1e-12);
  EXPECT_NEAR(model.logSurvival(kA, 50 * kMillisecond),
              std::log(100 + std::exp(-0.5)) - std::log(101), 1e-12);
}

TEST(EvidenceModel, TheTracksStayWhateverProbabilitiesWereLearnedFrom) {
  const Statistics first = startOf(followed(1), 1);
  const Watched watched = watch(first, startOf(followed(2), 2));
  const Model both(watched);
  const Model half(watched, Model::Learned::kFirst);
  const Model other(watched, Model::Learned::kSecond);
  expectSameTracks(both.tracks(), half.tracks());
  const auto survival = [](const Model& model) { return model.logSurvival(kA, kSecond); };
  EXPECT_NE(survival(half), survival(other));
  EXPECT_DOUBLE_EQ(survival(half), survival(Model(watch(first, {}))));
  const CrossFit cross_fit(watched);
  EXPECT_EQ(survival(*cross_fit.judging(0)), survival(other)) << "by what the other half says";
  EXPECT_EQ(survival(*cross_fit.judging(1)), survival(half));
  EXPECT_EQ(cross_fit.judging(std::nullopt), cross_fit.model());
  EXPECT_THROW(cross_fit.judging(2), std::out_of_range);
}

TEST(EvidenceModel, AHalfMayLackAnEventType) {
  const Statistics second =  // B alone, so that its id is another one
      countsOf({timer(0, 0, 10 * kSecond, 100 * kMillisecond)}, {kTypes[kB]});
  const Statistics first = countsOf({timer(kA, 0, 10 * kSecond, 100 * kMillisecond)}, 1);
  const Model model(watch(first, second), Model::Learned::kSecond);
  EXPECT_EQ(model.logSurvival(kA, kSecond), 0);
  EXPECT_LT(model.logSurvival(kB, kSecond), -1);
}

TEST(EvidenceModel, TheLongestGapsAreTheUsualOnesExactly) {
  // 5 Hz, of which one gap in fifty is 13 ms longer: within one bin.
  Events events;
  std::int64_t stamp = 0;
  for (int i = 0; i <= 1000; ++i) {
    events.push_back({stamp, kA});
    stamp += (i % 50 == 7 ? 213 : 200) * kMillisecond;
  }
  const Model model(watch(countsOf({events}), kNothing));
  EXPECT_DOUBLE_EQ(model.usualDelay(kA, kA, 1), 213 * kMillisecond);
  EXPECT_DOUBLE_EQ(model.usualDelay(kA, kA, 0.99), 213 * kMillisecond);
  EXPECT_DOUBLE_EQ(model.usualDelay(kA, kA, 0.975), 200 * kMillisecond);
  EXPECT_DOUBLE_EQ(model.meanGap(kA), 200.26 * kMillisecond);
  // The shorter ones are known as exactly as their bin, and never longer than the longest.
  EXPECT_GT(model.usualDelay(kA, kA, 0.01), 190 * kMillisecond);
  EXPECT_LT(model.usualDelay(kA, kA, 0.01), 200 * kMillisecond);
  EXPECT_LT(model.usualDelay(kA, kA, 0.96), 213 * kMillisecond);
  EXPECT_EQ(model.usualDelay(kB, kB, 0.5), 0);
  EXPECT_EQ(model.meanGap(kB), 0);
}

}  // namespace
}  // namespace self_awareness::core::evidence
