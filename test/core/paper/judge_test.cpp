#include "self_awareness/core/paper/judge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>

#include "core/paper/delay_trainer.h"
#include "core/paper/scorer.h"
#include "self_awareness/core/stream/mode.h"

namespace self_awareness::core::paper {
namespace {

constexpr std::int64_t kPeriod = 50000000;  // [ns]
constexpr EventId kUnknownId = 9;

class PaperJudgeTest : public testing::Test {
 protected:
  static std::shared_ptr<const Model> trained() {
    DelayStatistics statistics(Binning{});
    statistics.intern({"/a", "/x", "t"});
    statistics.intern({"/b", "/y", "t"});
    DelayTrainer trainer(statistics);
    for (std::int64_t i = 0; i < 100; ++i) {
      trainer.add({i * kPeriod, 0});
      trainer.add({i * kPeriod + 20000000, 1});
    }
    return std::make_shared<const Model>(statistics);
  }
  // Does what the windows do with the judge.
  void add(const Event& event) { window_.events.push_back(judge_->add(event).value()); }
  Judgement judge(std::int64_t end, NameSuspects suspects = NameSuspects::kIfUnusual) {
    Judgement judgement = judge_->judge(window_, end, suspects);
    window_.events.clear();
    return judgement;
  }
  // What the model was trained on goes on, and is judged once a period; at last A alone.
  Judgement run(int periods, bool alone = false) {
    Judgement judgement;
    for (const std::int64_t end = number_ + periods; number_ < end; ++number_) {
      add({number_ * kPeriod, 0});
      if (!alone) {
        add({number_ * kPeriod + 20000000, 1});
      }
      judgement = judge((number_ + 1) * kPeriod);
      EXPECT_TRUE(alone || !judgement.abnormal) << number_;
    }
    return judgement;
  }

  std::shared_ptr<const Model> model_ = trained();
  std::unique_ptr<core::Judge> judge_ = makeJudge(model_, 0.1, true);
  Window window_;
  std::int64_t number_ = 0;  // of the period
};

TEST_F(PaperJudgeTest, NamesTheComponentThatFellSilent) {
  judge_ = makeJudge(model_, 1.2, true);
  add({-kPeriod, 0});
  add({20000000 - kPeriod, 1});
  judge(0);
  run(20);
  const Judgement judgement = run(60, true);
  EXPECT_TRUE(judgement.abnormal);
  ASSERT_FALSE(judgement.suspects.empty());
  const Suspect& silent = judgement.suspects[0];
  EXPECT_EQ(silent.component, "/b");
  EXPECT_EQ(silent.reason.kind, Kind::kSilent);
  EXPECT_EQ(silent.reason.words, "silent for 3.03 s, usually every 0.050 to 0.060 s");
  const Judgement both = judge((number_ + 200) * kPeriod);
  ASSERT_EQ(both.suspects.size(), 2U);
  EXPECT_EQ(both.suspects[0].component, "/b") << "who has been silent for longer comes first";
}

TEST_F(PaperJudgeTest, SilenceOfAllIsAbnormalUnlessItIsIgnored) {
  for (const bool silence_is_abnormal : {true, false}) {
    judge_ = makeJudge(model_, 0.1, silence_is_abnormal);
    add({0, 0});
    judge(kPeriod);
    const Judgement silent = judge(2 * kPeriod);
    EXPECT_EQ(silent.abnormal, silence_is_abnormal);
    EXPECT_EQ(silent.evidence, silence_is_abnormal ? "silence" : "");
  }
}

TEST_F(PaperJudgeTest, SettlesWithANewComponentAndNotWithANewTopic) {
  DelayStatistics statistics{Binning{}};
  for (const EventType& type :
       {EventType{"/a", "/often", "T"}, {"/a", "/rarely", "T"}, {"/b", "/y", "T"}}) {
    statistics.countEvent(statistics.intern(type));
  }
  judge_ = makeJudge(std::make_shared<const Model>(statistics), 0.1, true);
  const auto settlesWith = [&](std::int64_t stamp, EventId id) {
    judge_->settle({stamp, id}, kPeriod);
    window_.start = stamp;
    return judge(stamp + 1).settling;
  };
  EXPECT_FALSE(settlesWith(0, 0)) << "the detector settles then";
  EXPECT_FALSE(settlesWith(2 * kPeriod, 1));
  EXPECT_TRUE(settlesWith(2 * kPeriod, 2));
}

TEST_F(PaperJudgeTest, RefusesAThresholdThatIsNoNumber) {
  for (const double none : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(makeJudge(model_, none, true), std::invalid_argument);
  }
}

TEST_F(PaperJudgeTest, ARestartForgetsTheScoresOfTheOpenWindow) {
  add({0, 0});
  judge_->restart();
  window_.events.clear();
  EXPECT_FALSE(judge(kPeriod).score);
}

TEST_F(PaperJudgeTest, AllSettlesWhereOneOfTheModelWasMissed) {
  const auto settlingAt = [this](std::int64_t start) {
    window_.start = start;
    return judge(start + 1).settling;
  };
  judge_->leaveOut({kUnknownId}, 2 * kPeriod);
  EXPECT_FALSE(settlingAt(kPeriod));
  judge_->leaveOut({1}, 2 * kPeriod);
  EXPECT_TRUE(settlingAt(kPeriod));
  EXPECT_FALSE(settlingAt(2 * kPeriod));
}

TEST_F(PaperJudgeTest, NamesSuspectsOnlyWhereTheyAreAskedFor) {
  const auto unknownWindow = [this](NameSuspects suspects) {
    add({kPeriod, kUnknownId});
    return judge(2 * kPeriod, suspects).suspects.size();
  };
  EXPECT_EQ(unknownWindow(NameSuspects::kIfUnusual), 1U);  // it scores 0, and is abnormal
  EXPECT_EQ(unknownWindow(NameSuspects::kNever), 0U);
  judge_ = makeJudge(model_, -1, true);  // nothing is abnormal
  EXPECT_EQ(unknownWindow(NameSuspects::kIfUnusual), 0U);
  EXPECT_EQ(unknownWindow(NameSuspects::kAlways), 1U);
  judge_ = makeJudge(model_, std::nullopt, true);
  EXPECT_EQ(unknownWindow(NameSuspects::kAlways), 0U);
}

TEST(PaperJudge, SeesNoMode) {
  DelayStatistics statistics{Binning{}};
  const EventType driving{"/logic", "/state", typeOfMode("S", "DRIVING")};
  statistics.countEvent(statistics.intern({"/a", "/x", "T"}));
  const EventId known = statistics.intern(driving);
  const auto heard = std::make_shared<Vocabulary>(statistics.vocabulary());
  const EventId unknown = heard->intern({"/logic", "/state", typeOfMode("S", "LOST")});
  const std::unique_ptr<core::Judge> judge =
      makeJudge(std::make_shared<Model>(statistics), std::nullopt, true, heard);
  EXPECT_FALSE(judge->add({0, known}));
  EXPECT_FALSE(judge->add({0, unknown}));
  EXPECT_TRUE(judge->add({0, 0}));
}

}  // namespace
}  // namespace self_awareness::core::paper
