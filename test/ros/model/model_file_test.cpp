// Tests good and bad model files.

#include "self_awareness/ros/model/model_file.h"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <std_msgs/String.h>

#include <boost/filesystem.hpp>
#include <cmath>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "model_file_case.h"
#include "ros/model/model_fields.h"
#include "self_awareness/ros/model/model_bytes.h"

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
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
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
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(ModelFileTest, SaysWhatIsWrongWithAModelFile) {
  EXPECT_NE(modelError(path("absent")).find("no such file"), std::string::npos);
  std_msgs::String message;
  rosbag::Bag bag(path("a.bag"), rosbag::bagmode::Write);
  bag.write("/a", ros::Time(1, 0), message);
  bag.close();
  EXPECT_NE(modelError(path("a.bag")).find("holds no model"), std::string::npos);
  std::ofstream(path("text")) << "no model";
  EXPECT_NE(modelError(path("text")).find("not a model file"), std::string::npos);
  saveModel(someModel(), path("cut"));
  fs::resize_file(path("cut"), fs::file_size(path("cut")) / 2);
  EXPECT_NE(modelError(path("cut")).find(path("cut")), std::string::npos);
}

TEST_F(ModelFileTest, ADamagedModelIsRefused) {
  using Model = TrainedModel;
  EXPECT_EQ(damagedModel([](Model& /*m*/) {}), "");
  EXPECT_NE(damagedModel([](Model& m) { m.window = 0; }), "");
  EXPECT_NE(damagedModel([](Model& m) { m.window = -core::kNanosecondsPerSecond; }), "");
  EXPECT_NE(damagedModel([](Model& m) { m.statistics = core::paper::DelayStatistics({}); }), "");
  EXPECT_NE(damagedModel([](Model& m) { m.encoding.exclude_topics = {"("}; }), "");
  EXPECT_NE(damagedModel([](Model& m) { m.paper_calibration.emplace().threshold = std::nan(""); }),
            "");
  EXPECT_NE(damagedPart("/model", [](std::vector<std::uint8_t>& bytes) { bytes.push_back(0); }),
            "");
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
  const std::string file = path("damaged") + ": a damaged model file: ";
  for (const auto& [missing, told] : std::map<std::string, std::string>{
           {"/delays", "its counts do not fit its event types"},
           {"/evidence/first", "its counts do not fit its event types"},
           {"/evidence/second", "its counts do not fit its event types"}}) {
    bool left_out = false;
    const std::string topic = missing;
    const std::string error =
        damagedFile([&](rosbag::Bag& damaged, const rosbag::MessageInstance& message) {
          if (!left_out && message.getTopic() == topic) {
            left_out = true;
          } else {
            damaged.write(message.getTopic(), message.getTime(), message);
          }
        });
    EXPECT_EQ(error, file + told);
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
