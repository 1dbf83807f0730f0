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
#include <tuple>
#include <utility>
#include <vector>

#include "model_file_case.h"
#include "ros/model/model_fields.h"
#include "self_awareness/core/evidence/channel/track.h"

namespace self_awareness::ros1 {
namespace {

namespace fs = boost::filesystem;

using core::evidence::LimitFinder;

/// All that is compared of a part of a model.
auto all(const core::RecordingInfo& of) {
  return std::tie(of.bag, of.start, of.end, of.events, of.robot_start, of.fingerprint, of.robot);
}
auto all(const core::evidence::Track& of) {
  return std::tie(of.channel, of.to, of.from);
}
auto all(const core::evidence::Relation& of) {
  return std::tie(of.watched, of.reaches, of.irregular, of.spread, of.starts, of.starts_needed);
}
auto all(const LimitFinder::Recording::Part& of) {
  return std::tie(of.windows, of.evidence, of.longest_gaps);
}
auto all(const LimitFinder::Recording& of) {
  return std::tie(of.start, of.end, of.trained_on, of.windows, of.said, of.robot);
}

template <typename Each>
bool same(const std::vector<Each>& one, const std::vector<Each>& other) {
  return std::equal(one.begin(), one.end(), other.begin(), other.end(),
                    [](const Each& a, const Each& b) { return all(a) == all(b); });
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
    EXPECT_TRUE(loaded.encoding == model.encoding);
    EXPECT_EQ(loaded.window, model.window);
    EXPECT_EQ(loaded.stamp, model.stamp);
    EXPECT_EQ(loaded.threshold(), 1.25);
    EXPECT_TRUE(same(loaded.recordings, model.recordings));
    EXPECT_TRUE(loaded.watched.halves == model.watched.halves);
    EXPECT_TRUE(same(loaded.watched.tracks, model.watched.tracks));
    EXPECT_TRUE(loaded.tuning == model.tuning && loaded.watched.tuning == model.tuning);
    EXPECT_TRUE(loaded.graph.edges() == model.graph.edges());
    EXPECT_EQ(loaded.graph.hostOf("/a"), "base");
    EXPECT_EQ(loaded.unheard(), model.graph.unheard());
    EXPECT_EQ(loaded.graph.lasting(), model.graph.lasting());
    const core::Calibration& calibration = loaded.calibration.value();
    EXPECT_TRUE(std::isnan(calibration.limits.tracks.at(0)));
    EXPECT_EQ(calibration.limits.tracks.at(1), 2.5);
    EXPECT_EQ(calibration.method, "held-out");
    EXPECT_EQ(calibration.budget, 0.25);
    EXPECT_EQ(calibration.windows, 1234U);
    EXPECT_EQ(calibration.false_alarms_per_hour, 0.125);
    EXPECT_TRUE(same(calibration.recordings, model.calibration->recordings));
    EXPECT_TRUE(same(calibration.relations, model.calibration->relations));
    EXPECT_TRUE(same(loaded.findings, model.findings));
    for (std::size_t k = 0; k < model.findings.size(); ++k) {
      EXPECT_TRUE(same(loaded.findings.at(k).parts, model.findings[k].parts)) << k;
    }
    if (&loaded != &loads.back()) {
      EXPECT_TRUE(loaded.statistics == model.statistics);
      EXPECT_TRUE(loaded.evidence == model.evidence);
      EXPECT_TRUE(loaded.evidence[0].leftOut() == pairs);
      EXPECT_EQ(loaded.evidence[1].delaysToAny(), model.watched.halves[1].delaysToAny());
    }
  }
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
