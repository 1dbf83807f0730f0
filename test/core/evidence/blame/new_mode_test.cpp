#include "core/evidence/blame/new_mode.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "../recordings.h"

namespace self_awareness::core::evidence {
namespace {

using Strings = std::vector<std::string>;

const std::vector<EventType> kRobot{{"/wheels", "/odom", "T"}, {"/laser", "/scan", "T"},
                                    {"/arm", "/joints", "T"},  {"/lidar", "/cloud", "T"},
                                    {"/slam", "/pose", "T"},   {"/imu", "/imu/data", "T"}};
constexpr EventId kSlam = 4;
constexpr EventId kImu = 5;
constexpr std::int64_t kEnd = 100 * kSecond;
constexpr std::int64_t kAgo = 30 * kSecond;

Events robot(std::int64_t start, unsigned seed) {
  Events events;
  for (EventId id = 0; id < kRobot.size(); ++id) {
    events = together({events, irregular(id, start, start + kEnd, 100 * kMillisecond, seed + id)});
  }
  return events;
}

class NewModeTest : public testing::Test {
 protected:
  NewModeTest() { graph_->connect("/laser", "/scan", "/slam"); }

  /// Judges who stopped so long ago [ns], all of them beyond their limits.
  std::optional<Silent> excuse(const std::vector<std::int64_t>& ages, std::int64_t now = kEnd) {
    Scorer scorer(model_, kWindow);
    Events last;
    for (EventId id = 0; id < kRobot.size(); ++id) {
      last.push_back({now - ages[id], id});
    }
    for (const Event& event : together({last})) {
      scorer.add(event);
    }
    scorer.closeWindow(now);
    shares_.assign(model_->tracks().size(), 0);
    for (EventId id = 0; id < kRobot.size(); ++id) {
      share(id) = ages[id] > 0 ? 2 : 0;
    }
    const Limits limits{std::vector<double>(model_->tracks().size(), 1), {}};
    return new_mode_->excuse(shares_, limits, scorer);
  }
  double& share(EventId id) { return shares_[indexOf(model_->tracks(), kOverdue, id, id)]; }

  std::vector<double> shares_;
  std::shared_ptr<SourceGraph> graph_ = std::make_shared<SourceGraph>();
  std::shared_ptr<const Model> model_ = std::make_shared<Model>(
      watch(countsOf({robot(0, 100)}, kRobot), countsOf({robot(kStart, 200)}, kRobot)));
  std::unique_ptr<NewMode> new_mode_ = std::make_unique<NewMode>(model_, graph_);
};

TEST_F(NewModeTest, NobodyIsToBlameWhereFourThatDoNotHearEachOtherStopTogether) {
  const std::optional<Silent> silent = excuse({kAgo, kAgo, kAgo + kSecond, kAgo, 0, 0});
  ASSERT_TRUE(silent);
  EXPECT_TRUE(silent->others_go_on);
  EXPECT_EQ(silent->components, (Strings{"/arm", "/laser", "/lidar", "/wheels"}));
  EXPECT_EQ(silent->since, kEnd - kAgo);
  EXPECT_EQ(shares_, std::vector<double>(shares_.size(), 0));
}

TEST_F(NewModeTest, ThreeAreFaults) {
  EXPECT_FALSE(excuse({kAgo, kAgo, kAgo, 0, 0, 0}));
  EXPECT_EQ(share(0), 2);
}

TEST_F(NewModeTest, AVictimIsNoneOfTheFour) {
  EXPECT_FALSE(excuse({kAgo, kAgo, kAgo, 0, kAgo, 0}));
  EXPECT_TRUE(excuse({kAgo, kAgo, kAgo, kAgo, kAgo, 0}));
  EXPECT_EQ(share(kSlam), 0) << "but excused with them";
}

TEST_F(NewModeTest, AVictimThatStopsLaterIsExcused) {
  EXPECT_TRUE(excuse({kAgo, kAgo, kAgo, kAgo, kAgo / 2, 0}));
  EXPECT_EQ(share(kSlam), 0);
}

TEST_F(NewModeTest, WhoStopsAtAnotherTimeIsNotExcused) {
  EXPECT_TRUE(excuse({kAgo, kAgo, kAgo, kAgo, 0, kAgo / 2}));
  EXPECT_EQ(share(kImu), 2);
  new_mode_->restart();
  EXPECT_FALSE(excuse({kAgo, kAgo, kAgo, 0, 0, kAgo / 2}));
}

TEST_F(NewModeTest, WhereNobodyIsHeardSinceAllAreSilent) {
  EXPECT_FALSE(excuse({kAgo, kAgo, kAgo, kAgo, kAgo - kSecond, kAgo - 2 * kSecond}));
  EXPECT_EQ(share(0), 2);
}

TEST_F(NewModeTest, WithoutAGraphTheyMayBeVictims) {
  new_mode_ = std::make_unique<NewMode>(model_, std::make_shared<SourceGraph>());
  EXPECT_FALSE(excuse({kAgo, kAgo, kAgo, kAgo, 0, 0}));
}

TEST_F(NewModeTest, WhoComesBackLastIsExcusedForAMoment) {
  EXPECT_TRUE(excuse({kAgo, kAgo, kAgo, kAgo, 0, 0}));
  EXPECT_TRUE(excuse({kAgo + kSecond, 0, 0, 0, 0, 0}, kEnd + kSecond));
  EXPECT_EQ(share(0), 0);
  EXPECT_FALSE(excuse({kAgo + 4 * kSecond, 0, 0, 0, 0, 0}, kEnd + 4 * kSecond));
  EXPECT_EQ(share(0), 2);
}

TEST_F(NewModeTest, AfterARestartNothingIsExcused) {
  EXPECT_TRUE(excuse({kAgo, kAgo, kAgo, kAgo, 0, 0}));
  new_mode_->restart();
  EXPECT_FALSE(excuse({kAgo + kSecond, 0, 0, 0, 0, 0}, kEnd + kSecond));
}

}  // namespace
}  // namespace self_awareness::core::evidence
