#include "monitor/drift_keeper.h"

#include <gtest/gtest.h>

#include <boost/filesystem.hpp>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "../await.h"
#include "monitor/stretch.h"
#include "ros/verdict/drift_file.h"

namespace self_awareness {
namespace {

namespace fs = boost::filesystem;

constexpr std::int64_t kSecond = core::kNanosecondsPerSecond;
constexpr std::int64_t kBegin = 1600000000 * kSecond;

class DriftKeeperTest : public testing::Test {
 protected:
  DriftKeeperTest() { fs::create_directory(folder_); }
  ~DriftKeeperTest() override {
    keeper_.reset();
    fs::remove_all(folder_);
  }
  DriftKeeperTest(const DriftKeeperTest&) = delete;
  DriftKeeperTest& operator=(const DriftKeeperTest&) = delete;

  /// The monitor is started. @param run of the roscore
  DriftKeeper& start(const std::string& run, std::uint64_t model = 1) {
    if (keeper_) {
      keeper_->finish();
    }
    keeper_ = std::make_unique<DriftKeeper>(run, ++started_);
    keeper_->setModel(model_, {model, components_});
    return *keeper_;
  }
  /// All are normal for a time, with these shares.
  void listen(const std::vector<double>& shares, std::int64_t seconds = 20) {
    for (std::int64_t k = 0; k < seconds; ++k, now_ += kSecond) {
      keeper_->add(now_, now_ + kSecond, shares);
    }
  }
  /// What is in the file after the monitor has ended, by the shares of all components in a row.
  std::vector<double> kept() {
    keeper_->finish();
    const auto read = ros1::readDrift(path_);
    return read ? read->shares : std::vector<double>();
  }

  const fs::path folder_ = fs::temp_directory_path() / fs::unique_path();
  const std::string model_ = (folder_ / "robot.model").string();
  const std::string path_ = ros1::pathOfDrift(model_);
  const std::vector<std::string> components_{"/slam", "/laser"};
  std::int64_t started_ = 0;
  std::int64_t now_ = kBegin;
  std::unique_ptr<DriftKeeper> keeper_;
};

TEST_F(DriftKeeperTest, AShareThatGrowsFromStartToStartIsToldAndAConstantOneIsNot) {
  for (int k = 0; k < 12; ++k) {
    start("run " + std::to_string(k));
    EXPECT_EQ(keeper_->told().empty(), k < 7) << k;
    listen({0.3 + 0.05 * k, 0.6 + 0.01 * (k % 2)});
  }
  keeper_->finish();
  ASSERT_EQ(keeper_->told().size(), 1U);
  EXPECT_EQ(keeper_->told()[0].component, "/slam");
  EXPECT_EQ(keeper_->told()[0].words.rfind("/slam 58 % -> 85 % of its limit, evidence ", 0), 0U)
      << keeper_->told()[0].words;
}

TEST_F(DriftKeeperTest, AMonitorThatIsStartedAgainGoesOnWithTheSampleOfItsRobot) {
  start("one");
  listen({0.1, 0.5});
  start("one");
  listen({0.2, 0.4});
  EXPECT_EQ(kept(), (std::vector<double>{0.2, 0.5}));
  start("two");
  listen({0.3, 0.3});
  EXPECT_EQ(kept(), (std::vector<double>{0.2, 0.5, 0.3, 0.3}));
  start("");
  listen({0.1, 0.1});
  start("");
  listen({0.1, 0.1});
  EXPECT_EQ(kept().size(), 8U) << "nobody knows whether the robot was started";
}

TEST_F(DriftKeeperTest, WhatIsNotNormalOrShortDoesNotCount) {
  start("one");
  keeper_->onNotNormal("an alarm");
  listen({0.1, 0.1});
  keeper_->onNotNormal("an alarm");
  listen({0.9, 0.1});
  keeper_->onCut(Cut::kClockSet);
  listen({0.8, 0.8}, 9);
  EXPECT_EQ(kept(), (std::vector<double>())) << "one was not normal, the next too short";
  EXPECT_FALSE(fs::exists(path_)) << "there is nothing to keep";
  start("one");
  listen({0.2, 0.3});
  EXPECT_EQ(kept(), (std::vector<double>{0.2, 0.3})) << "what was left out before is no matter";
}

TEST_F(DriftKeeperTest, AStretchEndsByItself) {
  start("one");
  listen({0.2, 0.3}, kLongestStretch / kSecond);
  EXPECT_TRUE(await([&] { return fs::exists(path_); }));
  listen({0.9, 0.9}, 60);
  keeper_->onNotNormal("an alarm");
  EXPECT_EQ(kept(), (std::vector<double>{0.2, 0.3})) << "that of before stays";
}

TEST_F(DriftKeeperTest, AnotherContentOfTheModelBeginsAnew) {
  start("one");
  listen({0.2, 0.3});
  start("two", 7);
  listen({0.4, 0.4});
  EXPECT_EQ(kept(), (std::vector<double>{0.4, 0.4}));
}

TEST_F(DriftKeeperTest, AReloadOfTheSameModelForgetsNothing) {
  start("one");
  listen({0.2, 0.3});
  keeper_->setModel(model_, {1, components_});
  listen({0.3, 0.2});
  EXPECT_EQ(kept(), (std::vector<double>{0.3, 0.3}));
  start("one");
  keeper_->setModel(model_, {1, {}});  // it has no limits now
  listen({0.4, 0.4});
  EXPECT_EQ(kept(), (std::vector<double>{0.3, 0.3}));
}

TEST_F(DriftKeeperTest, WhatIsJudgedAgainIsNoDrift) {
  start("one");
  listen({0.2, 0.3});
  keeper_->onCut(Cut::kClockSet);
  keeper_->forget();
  EXPECT_EQ(kept(), (std::vector<double>()));
}

TEST_F(DriftKeeperTest, AnotherMasterIsAnotherStart) {
  start("one");
  listen({0.2, 0.3});
  keeper_->onRobotStart(99);
  listen({0.1, 0.1});
  EXPECT_EQ(kept(), (std::vector<double>{0.2, 0.3, 0.1, 0.1}));
}

TEST_F(DriftKeeperTest, ADamagedFileBeginsAnew) {
  start("one");
  listen({0.2, 0.3});
  kept();
  std::ofstream(path_, std::ios::binary | std::ios::in).write("no bag", 6);
  start("two");
  EXPECT_TRUE(keeper_->told().empty());
  listen({0.4, 0.4});
  EXPECT_EQ(kept(), (std::vector<double>{0.4, 0.4}));
}

TEST_F(DriftKeeperTest, AFileThatCannotBeWrittenIsSaid) {
  fs::create_directory(path_);
  start("one");
  EXPECT_EQ(keeper_->error(), "");
  listen({0.2, 0.3});
  keeper_->onCut(Cut::kClockSet);
  EXPECT_TRUE(await([&] { return !keeper_->error().empty(); }));
}

}  // namespace
}  // namespace self_awareness
