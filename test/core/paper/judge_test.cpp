#include "self_awareness/core/paper/judge.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <optional>

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

  std::shared_ptr<const Model> model_ = trained();
  std::unique_ptr<core::Judge> judge_ = makeJudge(model_, 0.1, true);
  Window window_;
};

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
