// Tests good and bad model files.

#include "self_awareness/ros/model/model_file.h"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <std_msgs/String.h>

#include <boost/filesystem.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "model_file_case.h"
#include "ros/model/model_fields.h"
#include "self_awareness/core/evidence/channel/track.h"

namespace self_awareness::ros1 {
namespace {

namespace fs = boost::filesystem;

/// All of a model but the counts of further training.
std::vector<std::uint8_t> bytesOf(const TrainedModel& model) {
  ByteWriter bytes;
  writeModel(model, bytes);
  return bytes.take();
}

TEST_F(ModelFileTest, AModelComesBackAsItWasSaved) {
  TrainedModel model = calibratedModel();
  model.graph.connect("/a", "/x", "/b");
  model.graph.place("/a", "base");
  model.graph.addUnheard({"/planner", "/debug"});
  model.graph.addLasting({"/b", "/x"}, 3);
  model.tuning.least_effect = 0.003;
  model.tuning.changing_time = 3;  // the first and the last one are no exceptions
  model.tuning.fewest_gaps = 31;
  model.tuning.without = {"slower", "pairs"};
  core::evidence::PairSet pairs;
  pairs.add(1, 0);
  for (core::evidence::Statistics& half : model.evidence) {
    half = half.without(pairs);  // for good
  }
  model.recordings[0].robot = model.findings[0].robot = "r7";
  model.paper_calibration.emplace().threshold = 1.25;
  saveModel(model, path("m"));
  EXPECT_EQ(names(), std::set<std::string>{"m"});
  const std::vector<TrainedModel> loads{loadModel(path("m")), fromBytes(toBytes(model)),
                                        loadModel(path("m"), ModelCounts::kWatched)};
  for (const TrainedModel& loaded : loads) {
    EXPECT_EQ(bytesOf(loaded), bytesOf(model));
    // What is not written is equal in bytes, too.
    EXPECT_TRUE(loaded.encoding == model.encoding);
    EXPECT_EQ(loaded.window, model.window);
    EXPECT_EQ(loaded.stamp, model.stamp);
    EXPECT_EQ(loaded.threshold(), 1.25);
    EXPECT_EQ(loaded.recordings.at(0).robot + loaded.findings.at(0).robot, "r7r7");
    EXPECT_TRUE(loaded.watched.halves == model.watched.halves);
    EXPECT_TRUE(loaded.tuning == model.tuning && loaded.watched.tuning == model.tuning);
    EXPECT_TRUE(loaded.graph.edges() == model.graph.edges());
    EXPECT_EQ(loaded.graph.hostOf("/a"), "base");
    EXPECT_EQ(loaded.unheard(), model.graph.unheard());
    EXPECT_EQ(loaded.graph.lasting(), model.graph.lasting());
    const core::Calibration& calibration = loaded.calibration.value();
    EXPECT_TRUE(std::isnan(calibration.limits.tracks.at(0)));
    EXPECT_EQ(calibration.limits.tracks.at(1), 2.5);
    EXPECT_EQ(calibration.budget, 0.25);
    EXPECT_EQ(calibration.recordings.size(), 1U);
    EXPECT_EQ(calibration.relations.at(1).starts_needed, 3U);
    if (&loaded != &loads.back()) {
      EXPECT_TRUE(loaded.statistics == model.statistics);
      EXPECT_TRUE(loaded.evidence == model.evidence);
      EXPECT_TRUE(loaded.evidence[0].leftOut() == pairs);
      EXPECT_EQ(loaded.evidence[1].delaysToAny(), model.watched.halves[1].delaysToAny());
    }
  }
  // No more is read than is asked for.
  EXPECT_EQ(loads.back().statistics.eventCount(0), model.statistics.eventCount(0));
  EXPECT_EQ(loads.back().statistics.pairs(), 0U);
  EXPECT_EQ(loads.back().evidence[0].size(), 0U);
  const TrainedModel delays = loadModel(path("m"), ModelCounts::kDelays);
  EXPECT_TRUE(delays.statistics == model.statistics);
  EXPECT_EQ(delays.evidence[0].size(), 0U);
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

TEST_F(ModelFileTest, DamagedPairsAreRefused) {
  // Of one other type: its id, answers, first bin and counts; what was left out, and of which
  // pairs.
  using Counts = std::vector<std::uint32_t>;
  const auto error = [this](core::EventId other, std::size_t first, const Counts& counts,
                            const std::vector<std::uint8_t>& pairs = {}) {
    return damagedPart("/evidence/first", [&](std::vector<std::uint8_t>& bytes) {
      ByteWriter written;
      written(std::size_t{1}, other, std::uint64_t{0}, first, counts, false, pairs);
      bytes = written.take();
    });
  };
  const std::string file = path("damaged") + ": a damaged model file: ";
  EXPECT_EQ(error(1, 49, {7}), "");
  EXPECT_EQ(error(1, 49, {1, 1}), file + "its evidence has an impossible bin");
  EXPECT_EQ(error(0, 0, {1000}), file + "its evidence has more delays than gaps");
  EXPECT_NE(error(2, 0, {1}), "") << "there is no such type";
  EXPECT_NE(error(1, 0, {1}, {4}), "") << "nor this one";
  EXPECT_NE(error(1, 0, {1}, {2}), "") << "it has counts of this pair";
}

TEST_F(ModelFileTest, WhatThisVersionDoesNotKnowIsNotWatchedAndAllElseIs) {
  const TrainedModel whole = calibratedModel();
  std::string name = channelName(whole.watched.tracks.at(1));
  name.insert(name.begin(), static_cast<char>(name.size()));
  std::string unknown = name;
  unknown.back() = '?';
  ASSERT_EQ(channelName(whole.watched.tracks.at(0)), channelName(whole.watched.tracks.at(1)));
  ASSERT_EQ(damagedPart("/model", rename(name, unknown)), "");
  const TrainedModel model = loadModel(path("damaged"));
  EXPECT_EQ(model.left_out, (std::set<std::string>{unknown.substr(1)}));
  ASSERT_EQ(model.watched.tracks.size() + 1, whole.watched.tracks.size());
  EXPECT_EQ(model.limits()->tracks,
            std::vector<double>(model.watched.tracks.size(), 2.5));  // the first one had none
  EXPECT_EQ(model.calibration->relations.size(), model.watched.tracks.size());
  EXPECT_TRUE(model.calibration->relations.at(0).watched) << "that of the second one";
  for (std::size_t k = 0; k < model.findings.size(); ++k) {
    const core::evidence::LimitFinder::Recording& all = whole.findings[k];
    const core::evidence::LimitFinder::Recording& left = model.findings[k];
    EXPECT_EQ(left.said,
              (std::vector<core::evidence::Said>(all.said.begin() + 1, all.said.end())));
    for (std::size_t part = 0; part < all.parts.size(); ++part) {
      EXPECT_EQ(left.parts[part].evidence[1], all.parts[part].evidence[2]);
    }
  }
  saveModel(model, path("again"));
  EXPECT_EQ(loadModel(path("again")).watched.tracks.size(), model.watched.tracks.size());
}

TEST_F(ModelFileTest, OfATuningWhatIsMissingHasItsDefaultAndWhatIsUnknownIsLeftOut) {
  ASSERT_EQ(damagedPart("/model", rename("fewest_gaps", "fewest_gape")), "");
  EXPECT_TRUE(loadModel(path("damaged")).tuning == core::evidence::Tuning());
}

}  // namespace
}  // namespace self_awareness::ros1
