// A channel is a pair of files and a line in a list: all else learns of it from there. This
// program has one channel more than the method.

#include "toy_channel.h"

#include <gtest/gtest.h>

#include <boost/filesystem.hpp>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "../core/evidence/judged.h"
#include "core/evidence/lanes.h"
#include "self_awareness/core/evidence/judge.h"
#include "self_awareness/ros/model/model_file.h"

namespace self_awareness::core::evidence {
namespace {

constexpr char kBursts[] = "bursts";
constexpr std::int64_t kLength = 100 * kSecond;
constexpr std::int64_t kFault = 50 * kSecond;  // after the start of a recording
constexpr int kAtOnce = 15;
const std::vector<EventType> kRobot{{"/a", "/x", "T"}, {"/b", "/y", "T"}};

// Two components that have nothing to do with each other; one of them may hold back what it has to
// say for a moment, and then say it at once.
Events robot(unsigned seed, bool burst) {
  Events events = together({irregular(kA, 0, kLength, 200 * kMillisecond, seed),
                            irregular(kB, 0, kLength, 50 * kMillisecond, seed + 100)});
  if (burst) {
    events = without(events, [](const Event& event) {
      return event.id == kA && std::abs(event.stamp - kFault) < 600 * kMillisecond;
    });
    events = together({events, timer(kA, kFault, kFault + kAtOnce * kMillisecond, kMillisecond)});
  }
  return later(events, seed * kStart);
}

/// What is learned from recordings of normal operation.
ros1::TrainedModel trained(const Tuning& tuning) {
  std::vector<Events> recordings;
  for (unsigned number = 0; number < 4; ++number) {
    recordings.push_back(robot(number, false));
  }
  ros1::TrainedModel model(learnedFrom(kRobot, recordings, tuning));
  model.encoding = ros1::EncodingRules::defaults();
  model.stamp = 1700000000 * kSecond;
  return model;
}

class ToyChannelTest : public testing::Test {
 protected:
  ToyChannelTest() {
    // The gaps would find a burst, too.
    Tuning tuning;
    tuning.without = {kSlower, kFaster};
    ros1::saveModel(trained(tuning), file("robot.model"));
    model_ = ros1::loadModel(file("robot.model"));
    bursts_ = indexOf(model_.watched.tracks, kBursts, kA, kA);
  }
  ~ToyChannelTest() override { boost::filesystem::remove_all(folder_); }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }

  /// Judges a recording; returns the verdicts with which an alarm began.
  std::vector<Verdict> alarmsIn(const Events& events,
                                const SharesHandler& shares = nullptr) const {
    std::vector<Verdict> alarms;
    judge(makeJudge(std::make_shared<Model>(model_.watched), model_.limits(), model_.window,
                    std::make_shared<SourceGraph>(), nullptr, shares),
          events, [&](const Verdict& verdict) {
            if (verdict.changed && verdict.alarm) {
              alarms.push_back(verdict);
            }
          });
    return alarms;
  }

  const boost::filesystem::path folder_ =
      boost::filesystem::temp_directory_path() / boost::filesystem::unique_path();
  const bool created_ = boost::filesystem::create_directory(folder_);
  ros1::TrainedModel model_;
  std::size_t bursts_ = 0;
  const Events faulty_ = robot(11, true);
  const std::string words_ = std::to_string(kAtOnce) + " at once, usually one every 0.2";
};

TEST_F(ToyChannelTest, IsWatchedAndHasALimitAlsoInTheModelFile) {
  ASSERT_LT(bursts_, model_.watched.tracks.size());
  EXPECT_EQ(channelLabel(model_.watched.tracks[bursts_]), kBursts);
  EXPECT_TRUE(isWatched(model_.watched.tracks, kBursts, kB, kB));
  const double limit = model_.limits()->tracks.at(bursts_);
  EXPECT_GE(limit, 4);
  EXPECT_LT(limit, kAtOnce);
  EXPECT_TRUE(model_.calibration->relations.at(bursts_).watched);
  EXPECT_GT(model_.findings.at(0).parts.at(0).evidence.at(bursts_), 0);
  for (const ros1::TrainedModel& again :
       {ros1::loadModel(file("robot.model"), ros1::ModelCounts::kWatched),
        ros1::fromBytes(ros1::toBytes(model_))}) {
    EXPECT_EQ(indexOf(again.watched.tracks, kBursts, kA, kA), bursts_);
    EXPECT_EQ(again.limits()->tracks.at(bursts_), limit);
  }
}

TEST_F(ToyChannelTest, CanBeSwitchedOffByItsName) {
  Tuning tuning;
  tuning.without = {kBursts};
  EXPECT_NO_THROW(tuning.validate());
  EXPECT_FALSE(isWatched(trained(tuning).watched.tracks, kBursts, kA, kA));
}

TEST_F(ToyChannelTest, ABurstIsAnAlarmThatNamesItInItsOwnWords) {
  EXPECT_TRUE(alarmsIn(robot(10, false)).empty());
  const std::vector<Verdict> alarms = alarmsIn(faulty_);
  ASSERT_EQ(alarms.size(), 1U);
  EXPECT_EQ(alarms[0].evidence, kBursts);
  ASSERT_EQ(alarms[0].suspects.size(), 1U);
  const Suspect& suspect = alarms[0].suspects[0];
  EXPECT_EQ(suspect.component, "/a");
  EXPECT_TRUE(suspect.abnormal);
  EXPECT_EQ(suspect.reason.words.rfind(words_, 0), 0U) << suspect.reason.words;
}

TEST_F(ToyChannelTest, TheReportDrawsItsShare) {
  const auto model = std::make_shared<Model>(model_.watched);
  const std::int64_t start = faulty_.front().stamp;
  Lanes lanes(model, {start, start + kFault - kSecond, start + kFault + kSecond});
  alarmsIn(faulty_,
           [&](const Window& window, const Shares& shares) { lanes.add(window, shares); });
  const std::vector<Lanes::Column>& columns = lanes.columns();
  EXPECT_LT(columns[0].strongest_share, 1);
  EXPECT_EQ(columns[1].track, bursts_);
  EXPECT_FLOAT_EQ(columns[1].strongest_share,
                  static_cast<float>(kAtOnce / model_.limits()->tracks[bursts_]));
  EXPECT_EQ(columns[1].shares[model->componentIndex(kA)], columns[1].strongest_share);
  EXPECT_LT(columns[2].strongest_share, 1);
}

}  // namespace
}  // namespace self_awareness::core::evidence
