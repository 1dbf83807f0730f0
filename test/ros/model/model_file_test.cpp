// Tests good and bad model files.

#include "self_awareness/ros/model/model_file.h"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <std_msgs/String.h>

#include <boost/filesystem.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "model_file_case.h"
#include "ros/model/model_fields.h"

namespace self_awareness::ros1 {
namespace {

namespace fs = boost::filesystem;

TEST_F(ModelFileTest, AModelComesBackAsItWasSaved) {
  TrainedModel model = someModel();
  saveModel(model, path("m"));
  TrainedModel loaded = loadModel(path("m"));
  EXPECT_TRUE(loaded.statistics == model.statistics);
  EXPECT_TRUE(loaded.encoding == model.encoding);
  EXPECT_EQ(loaded.window, model.window);
  EXPECT_EQ(loaded.stamp, model.stamp);
  EXPECT_FALSE(loaded.threshold());
  ASSERT_EQ(loaded.recordings.size(), 1U);
  EXPECT_EQ(loaded.recordings[0].fingerprint, model.recordings[0].fingerprint);

  loaded.paper_calibration = core::paper::Calibration();
  loaded.paper_calibration->threshold = 1.25;
  loaded.paper_calibration->method = "youden";
  saveModel(loaded, path("m"));
  EXPECT_EQ(loadModel(path("m")).threshold(), 1.25);
  EXPECT_EQ(names(), std::set<std::string>{"m"});
}

TEST_F(ModelFileTest, AModelForOneDetectorComesBackWithoutTheOthersCounts) {
  const TrainedModel both = someModel();
  TrainedModel evidence = both;
  evidence.statistics = core::paper::DelayStatistics(both.statistics.binning());
  for (const core::EventType& type : both.vocabulary().types()) {
    evidence.statistics.countEvent(evidence.statistics.intern(type));
  }
  TrainedModel paper = both;
  paper.evidence = {};
  paper.watched = {};
  for (const TrainedModel& model : {evidence, paper}) {
    saveModel(model, path("m"));
    for (const TrainedModel& loaded : {loadModel(path("m")), fromBytes(toBytes(model))}) {
      EXPECT_EQ(loaded.detectors(), model.detectors());
      EXPECT_EQ(loaded.hasDelays(), model.hasDelays());
      EXPECT_EQ(loaded.hasEvidence(), model.hasEvidence());
      EXPECT_TRUE(loaded.statistics == model.statistics);
      EXPECT_TRUE(loaded.evidence == model.evidence);
    }
  }
  EXPECT_THROW(evidence.requireDelays(), std::invalid_argument);
  EXPECT_THROW(paper.requireWatched(), std::invalid_argument);
  EXPECT_NO_THROW(evidence.requireWatched());
  EXPECT_NO_THROW(paper.requireDelays());
  EXPECT_EQ(loadModel(path("m"), ModelCounts::kWatched).detectors(), "paper");
  TrainedModel nothing = paper;
  nothing.dropCounts();
  EXPECT_THROW(saveModel(nothing, path("m")), std::logic_error);
}

TEST_F(ModelFileTest, AModelThatCannotBeWrittenLeavesNothingBehind) {
  EXPECT_THROW(saveModel(someModel(), path("no/such/folder/m")), ModelFileError);
  fs::create_directory(path("taken"));
  EXPECT_THROW(saveModel(someModel(), path("taken")), ModelFileError);
  EXPECT_EQ(names(), std::set<std::string>{"taken"});
}

TEST_F(ModelFileTest, SaysWhatIsWrongWithAModelFile) {
  EXPECT_TRUE(has(modelError(path("absent")), "no such file"));
  rosbag::Bag bag(path("a.bag"), rosbag::bagmode::Write);
  bag.write("/a", ros::Time(1, 0), std_msgs::String());
  bag.close();
  EXPECT_TRUE(has(modelError(path("a.bag")), "holds no model"));
  writeFile(path("text"), "no model");
  EXPECT_TRUE(has(modelError(path("text")), "not a model file"));
  saveModel(someModel(), path("cut"));
  fs::resize_file(path("cut"), fs::file_size(path("cut")) / 2);
  EXPECT_TRUE(begins(modelError(path("cut")), path("cut")));
}

TEST_F(ModelFileTest, DamagedDelaysAreRefused) {
  using Entries = core::paper::Histogram::Entries;
  const auto error = [this](const Entries& from_a, const Entries& from_b) {
    return damagedPart("/delays", [&](std::vector<std::uint8_t>& bytes) {
      ByteWriter written;
      written(from_a, from_b);
      bytes = written.take();
    });
  };
  EXPECT_EQ(error({{0, 1}, {3, 2}}, {}), "");
  const std::string told =
      path("damaged") + ": a damaged model file: a histogram has an impossible bin";
  EXPECT_EQ(error({{0, 0}}, {}), told);
  EXPECT_EQ(error({{-1, 1}}, {}), told);
  EXPECT_EQ(error({}, {{3, 1}, {3, 1}}), told);
  EXPECT_EQ(error({{std::numeric_limits<std::int64_t>::max(), 1}}, {}), told);
}

TEST_F(ModelFileTest, AMissingMessageIsRefused) {
  for (const std::string topic : {"/delays", "/evidence/first", "/evidence/second"}) {
    bool left_out = false;
    const std::string error =
        damagedFile([&](rosbag::Bag& damaged, const rosbag::MessageInstance& message) {
          if (message.getTopic() != topic || std::exchange(left_out, true)) {
            damaged.write(message.getTopic(), message.getTime(), message);
          }
        });
    EXPECT_EQ(error,
              path("damaged") + ": a damaged model file: its counts do not fit its event types");
  }
}

TEST_F(ModelFileTest, NoMoreIsReadThanIsAskedFor) {
  const TrainedModel model = calibratedModel();
  saveModel(model, path("m"));
  const TrainedModel watched = loadModel(path("m"), ModelCounts::kWatched);
  EXPECT_EQ(watched.vocabulary().types(), model.vocabulary().types());
  EXPECT_EQ(watched.statistics.eventCount(0), model.statistics.eventCount(0));
  EXPECT_EQ(watched.statistics.pairs(), 0U);
  EXPECT_EQ(watched.evidence[0].size(), 0U);
  EXPECT_TRUE(watched.watched.halves[0] == model.watched.halves[0]);
  const TrainedModel delays = loadModel(path("m"), ModelCounts::kDelays);
  EXPECT_TRUE(delays.statistics == model.statistics);
  EXPECT_EQ(delays.evidence[0].size(), 0U);
}

}  // namespace
}  // namespace self_awareness::ros1
