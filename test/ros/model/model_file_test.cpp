// Tests good and bad model files.

#include "self_awareness/ros/model/model_file.h"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/String.h>

#include <boost/filesystem.hpp>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "core/paper/delay_trainer.h"
#include "self_awareness/DelayHistograms.h"
#include "self_awareness/core/evidence/limits.h"
#include "self_awareness/core/evidence/model.h"
#include "self_awareness/ros/model/evidence_message.h"
#include "self_awareness/ros/model/model_bytes.h"

namespace self_awareness::ros1 {
namespace {

namespace fs = boost::filesystem;

class ModelFileTest : public testing::Test {
 protected:
  ModelFileTest()
      : folder_(fs::temp_directory_path() / fs::unique_path("self_awareness-%%%%%%%%")) {
    fs::create_directory(folder_);
  }
  ~ModelFileTest() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  static std::string modelError(const std::string& file) {
    try {
      loadModel(file);
    } catch (const ModelFileError& error) {
      return error.what();
    }
    return "";
  }

  static TrainedModel someModel() {
    TrainedModel model;
    model.encoding = EncodingRules::defaults();
    model.statistics = core::paper::DelayStatistics(core::paper::Binning{5000000, 20});
    const core::EventId a = model.statistics.intern({"/a", "/x", "T"});
    const core::EventId b = model.statistics.intern({"/b", "/y", "T[action=1]"});
    core::paper::DelayTrainer trainer(model.statistics);
    for (core::evidence::Statistics& half : model.evidence) {
      half.intern(model.statistics.vocabulary().at(a));
      half.intern(model.statistics.vocabulary().at(b));
      core::evidence::Trainer evidence(half, model.window);
      for (int i = 0; i < 150; ++i) {
        const core::Event event{i * 37000000LL, i % 3 == 0 ? b : a};
        trainer.add(event);
        evidence.add(event);
      }
      trainer.startRecording();
      evidence.finish();
    }
    model.watch();
    model.stamp = ros::Time(1700000000, 0);
    self_awareness::Recording recording;
    recording.bag = "normal.bag";
    recording.events = 300;
    recording.fingerprint = 0xfedcba9876543210;
    model.recordings = {recording};
    return model;
  }

  // Limits for everything that the model watches; the first track is not judged.
  static TrainedModel calibratedModel() {
    TrainedModel model = someModel();
    model.evidence_calibration = self_awareness::EvidenceCalibration();
    model.evidence_calibration->method = self_awareness::EvidenceCalibration::HELD_OUT;
    model.evidence_calibration->limits.assign(model.watched.tracks.size(), 2.5);
    model.evidence_calibration->limits.at(0) = std::numeric_limits<double>::quiet_NaN();
    model.evidence_calibration->linker_limit = 1.5;
    model.evidence_calibration->budget = 0.25;
    model.evidence_calibration->windows = 1234;
    model.evidence_calibration->recordings = model.recordings;
    model.evidence_calibration->false_alarms_per_hour = 0.125;
    self_awareness::Relation relation;
    relation.spread = 0.25;
    relation.starts = 2;
    relation.starts_needed = 3;
    model.evidence_calibration->relations.assign(model.watched.tracks.size(), relation);
    model.evidence_calibration->relations.at(1).watched = 1;
    model.evidence_calibration->relations.at(1).reaches = 1;
    model.evidence_calibration->relations.at(1).irregular = 1;
    model.findings = someFindings(model);
    return model;
  }

  // What two recordings of the training showed, one of them in two parts.
  static core::evidence::LimitFinder::Findings someFindings(const TrainedModel& model) {
    using core::evidence::LimitFinder;
    LimitFinder::Findings findings(2);
    for (std::size_t k = 0; k < findings.size(); ++k) {
      LimitFinder::Recording& recording = findings[k];
      recording.start = 1000000000LL * static_cast<std::int64_t>(k + 1);
      recording.end = recording.start + 123456789;
      recording.trained_on = true;
      for (std::size_t part = 0; part <= k; ++part) {
        LimitFinder::Recording::Part& added = recording.parts.emplace_back();
        added.windows = 100 * k + part;
        recording.windows += added.windows;
        for (std::size_t track = 0; track < model.watched.tracks.size(); ++track) {
          added.evidence.push_back(static_cast<float>(track) + 0.5F * static_cast<float>(part));
        }
        for (std::size_t id = 0; id < model.vocabulary().size(); ++id) {
          added.longest_gaps.push_back(static_cast<std::int64_t>(1000 * id + part));
        }
      }
      for (std::size_t track = 0; track < model.watched.tracks.size(); ++track) {
        recording.said.push_back(static_cast<LimitFinder::Said>((track + k) % 3));
      }
    }
    return findings;
  }

  // Error on loading a model file whose messages a test has changed.
  std::string damagedFile(
      const std::function<void(rosbag::Bag&, const rosbag::MessageInstance&)>& write) {
    saveModel(calibratedModel(), path("whole"));
    const rosbag::Bag whole(path("whole"), rosbag::bagmode::Read);
    rosbag::Bag damaged(path("damaged"), rosbag::bagmode::Write);
    for (const rosbag::MessageInstance& message : rosbag::View(whole)) {
      write(damaged, message);
    }
    damaged.close();
    return modelError(path("damaged"));
  }
  template <typename Message, typename Change>
  std::string damagedMessages(const std::string& topic, Change change) {
    return damagedFile([&](rosbag::Bag& damaged, const rosbag::MessageInstance& message) {
      if (message.getTopic() == topic) {
        const auto changed = message.instantiate<Message>();
        change(*changed);
        damaged.write(topic, message.getTime(), *changed);
      } else {
        damaged.write(message.getTopic(), message.getTime(), message);
      }
    });
  }
  template <typename Change>
  std::string damagedModel(Change change) {
    return damagedMessages<self_awareness::Model>("/model", change);
  }

  fs::path folder_;
};

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

  loaded.calibration = self_awareness::Calibration();
  loaded.calibration->threshold = 1.25;
  loaded.calibration->method = "youden";
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

TEST_F(ModelFileTest, AModelOfAnotherVersionIsRefused) {
  // The md5 of another version of the package.
  saveModel(someModel(), path("m"));
  std::ifstream in(path("m"), std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const std::string md5 = ros::message_traits::md5sum<self_awareness::Model>();
  std::size_t replaced = 0;
  for (std::size_t at = bytes.find(md5); at != std::string::npos; at = bytes.find(md5, at + 1)) {
    bytes.replace(at, md5.size(), "0123456789abcdef0123456789abcdef");
    ++replaced;
  }
  ASSERT_GT(replaced, 0U);
  std::ofstream(path("m"), std::ios::binary) << bytes;
  EXPECT_NE(modelError(path("m")).find("another version"), std::string::npos)
      << modelError(path("m"));
}

TEST_F(ModelFileTest, ADamagedModelIsRefused) {
  EXPECT_EQ(damagedModel([](self_awareness::Model& /*model*/) {}), "");
  using Message = self_awareness::Model;
  EXPECT_NE(damagedModel([](Message& m) { m.bin_size = 0; }), "");
  EXPECT_NE(damagedModel([](Message& m) { m.window = ros::Duration(0); }), "");
  EXPECT_NE(damagedModel([](Message& m) { m.window = ros::Duration(-1); }), "");
  EXPECT_NE(damagedModel([](Message& m) { m.event_types[1] = m.event_types[0]; }), "");
  EXPECT_NE(damagedModel([](Message& m) { m.event_types.clear(); }), "");
  EXPECT_NE(damagedModel([](Message& m) { m.encoding.source = "colour"; }), "");
  EXPECT_NE(damagedModel([](Message& m) { m.encoding.exclude_topics = {"("}; }), "");
  EXPECT_NE(damagedModel([](Message& m) {
              m.calibration.resize(1);
              m.calibration[0].threshold = std::nan("");
            }),
            "");
}

TEST_F(ModelFileTest, DamagedDelaysAreRefused) {
  using Delays = self_awareness::DelayHistograms;
  const auto error = [this](void (*change)(Delays&)) {
    return damagedMessages<Delays>("/delays", change);
  };
  EXPECT_EQ(error([](Delays& /*d*/) {}), "");
  const std::string file = path("damaged") + ": a damaged model file: ";
  for (const auto change : std::vector<void (*)(Delays&)>{
           [](Delays& d) { d.offsets.pop_back(); }, [](Delays& d) { d.bins.pop_back(); },
           [](Delays& d) { d.offsets[1] = 1000000; }, [](Delays& d) { d.to_id = 2; }}) {
    EXPECT_EQ(error(change), file + "its histograms do not fit its event types");
  }
  EXPECT_EQ(error([](Delays& d) { d.counts[0] = 0; }), file + "a histogram has an impossible bin");
  EXPECT_EQ(error([](Delays& d) { d.bins[0] = -1; }), file + "a histogram has an impossible bin");
  EXPECT_EQ(error([](Delays& d) {
              d.offsets = {0, 2, 2};
              d.bins = {3, 3};
              d.counts = {1, 1};
            }),
            file + "a histogram has an impossible bin");
}

TEST_F(ModelFileTest, AMissingMessageIsRefused) {
  const std::string file = path("damaged") + ": a damaged model file: ";
  for (const auto& [missing, told] : std::map<std::string, std::string>{
           {"/delays", "its histograms do not fit its event types"},
           {"/evidence/first", "its evidence does not fit its event types"},
           {"/evidence/second", "its evidence does not fit its event types"}}) {
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

TEST_F(ModelFileTest, TheEvidenceItsLimitsAndTheGraphComeBackAsTheyWereSaved) {
  TrainedModel model = calibratedModel();
  model.graph.connect("/a", "/x", "/b");
  model.graph.connect("/a", "/y", "/c");
  ASSERT_GE(model.evidence_calibration->limits.size(), 6U);
  saveModel(model, path("m"));
  const TrainedModel loaded = loadModel(path("m"));
  EXPECT_TRUE(loaded.evidence[0] == model.evidence[0]);
  EXPECT_TRUE(loaded.evidence[1] == model.evidence[1]);
  EXPECT_TRUE(loaded.watched.halves[0] == model.watched.halves[0]);
  EXPECT_TRUE(loaded.watched.halves[1] == model.watched.halves[1]);
  ASSERT_EQ(loaded.watched.tracks.size(), model.watched.tracks.size());
  for (std::size_t track = 0; track < loaded.watched.tracks.size(); ++track) {
    EXPECT_EQ(loaded.watched.tracks[track].channel, model.watched.tracks[track].channel);
    EXPECT_EQ(loaded.watched.tracks[track].to, model.watched.tracks[track].to);
    EXPECT_EQ(loaded.watched.tracks[track].from, model.watched.tracks[track].from);
  }
  EXPECT_EQ(loaded.predecessors, model.predecessors);
  EXPECT_EQ(loaded.graph.edges().size(), 2U);
  EXPECT_TRUE(loaded.graph.edges() == model.graph.edges());
  const core::evidence::Limits limits = loaded.limits().value();
  ASSERT_EQ(limits.tracks.size(), model.evidence_calibration->limits.size());
  EXPECT_TRUE(std::isnan(limits.tracks[0]));
  EXPECT_EQ(limits.tracks[1], 2.5);
  EXPECT_EQ(limits.linker, 1.5);
  EXPECT_EQ(loaded.evidence_calibration->method, "held-out");
  EXPECT_EQ(loaded.evidence_calibration->budget, 0.25);
  EXPECT_EQ(loaded.evidence_calibration->windows, 1234U);
  EXPECT_EQ(loaded.evidence_calibration->recordings.at(0).bag, "normal.bag");
  EXPECT_FALSE(loadModel([this] {
                 saveModel(someModel(), path("bare"));
                 return path("bare");
               }())
                   .limits());
}

TEST_F(ModelFileTest, WhatTheTrainingShowedComesBackAsItWasSaved) {
  const TrainedModel model = calibratedModel();
  saveModel(model, path("m"));
  for (const TrainedModel& loaded :
       {loadModel(path("m")), loadModel(path("m"), ModelCounts::kWatched),
        fromBytes(toBytes(model))}) {
    ASSERT_EQ(loaded.findings.size(), 2U);
    for (std::size_t k = 0; k < 2; ++k) {
      const core::evidence::LimitFinder::Recording& saved = model.findings[k];
      const core::evidence::LimitFinder::Recording& found = loaded.findings[k];
      EXPECT_EQ(found.start, saved.start);
      EXPECT_EQ(found.end, saved.end);
      EXPECT_TRUE(found.trained_on);
      EXPECT_EQ(found.windows, saved.windows);
      EXPECT_EQ(found.said, saved.said);
      ASSERT_EQ(found.parts.size(), saved.parts.size());
      for (std::size_t part = 0; part < saved.parts.size(); ++part) {
        EXPECT_EQ(found.parts[part].windows, saved.parts[part].windows);
        EXPECT_EQ(found.parts[part].evidence, saved.parts[part].evidence);
        EXPECT_EQ(found.parts[part].longest_gaps, saved.parts[part].longest_gaps);
      }
    }
    // Recordings of the training, of each half one.
    for (const core::evidence::Statistics& half : loaded.watched.halves) {
      ASSERT_EQ(half.recordings().size(), 1U);
      EXPECT_EQ(half.recordings()[0].end, 149 * 37000000LL);
      EXPECT_EQ(half.recordings()[0].longest_silence, 37000000);
      EXPECT_EQ(half.recordings()[0].events, (std::vector<std::uint64_t>{100, 50}));
      EXPECT_EQ(half.recordings()[0].longest_gaps,
                (std::vector<std::int64_t>{2 * 37000000, 3 * 37000000}));
    }
  }
  EXPECT_TRUE(model.watched.halves[0] == loadModel(path("m")).watched.halves[0]);
}

TEST_F(ModelFileTest, WhatSpeaksForRelationsComesBackAsItWasSaved) {
  const TrainedModel model = calibratedModel();
  saveModel(model, path("m"));
  const TrainedModel loaded = loadModel(path("m"));
  EXPECT_EQ(loaded.evidence_calibration->false_alarms_per_hour, 0.125);
  const std::vector<self_awareness::Relation>& relations = loaded.evidence_calibration->relations;
  ASSERT_EQ(relations.size(), model.watched.tracks.size());
  for (std::size_t track = 0; track < relations.size(); ++track) {
    const core::evidence::Relation relation = fromMessage(relations[track]);
    EXPECT_EQ(relation.watched, track == 1);
    EXPECT_EQ(relation.reaches, track == 1);
    EXPECT_EQ(relation.irregular, track == 1);
    EXPECT_EQ(relation.spread, 0.25);
    EXPECT_EQ(relation.starts, 2U);
    EXPECT_EQ(relation.starts_needed, 3U);
    EXPECT_EQ(toMessage(relation).starts_needed, 3U);
  }
}

TEST_F(ModelFileTest, DamagedFindingsAreRefused) {
  using Message = self_awareness::Model;
  using Findings = self_awareness::RecordingFindings;
  const std::string file = path("damaged") + ": a damaged model file: its findings ";
  for (const auto change : std::vector<void (*)(Findings&)>{
           [](Findings& f) { f.part_windows.push_back(1); },
           [](Findings& f) { f.evidence.pop_back(); },
           [](Findings& f) { f.longest_gaps.push_back(1); }, [](Findings& f) { f.said.pop_back(); }}) {
    EXPECT_EQ(damagedModel([change](Message& model) { change(model.findings.at(1)); }),
              file + "do not fit its tracks");
  }
  EXPECT_EQ(damagedModel([](Message& model) { model.findings.at(0).said.at(0) = 3; }),
            file + "say what this version does not know");
  const auto recording = [this](void (*change)(self_awareness::RecordingCounts&)) {
    return damagedModel(
        [change](Message& model) { change(model.watched.at(0).recordings.at(0)); });
  };
  const std::string told =
      path("damaged") + ": a damaged model file: its recordings do not fit its event types";
  EXPECT_EQ(recording([](self_awareness::RecordingCounts& r) { r.events.push_back(1); }), told);
  EXPECT_EQ(recording([](self_awareness::RecordingCounts& r) {
              r.events.push_back(1);
              r.longest_gaps.push_back(1);
            }),
            told);
}

TEST_F(ModelFileTest, DamagedEvidenceIsRefused) {
  using Message = self_awareness::Model;
  using Evidence = self_awareness::Evidence;
  const auto error = [this](void (*change)(Evidence&)) {
    return damagedModel([change](Message& model) { change(model.watched.at(1)); });
  };
  const std::string file = path("damaged") + ": a damaged model file: its evidence ";
  for (const auto change : std::vector<void (*)(Evidence&)>{
           [](Evidence& e) { e.events.pop_back(); }, [](Evidence& e) { e.gaps.push_back(1); },
           [](Evidence& e) { e.gap_sums.clear(); }, [](Evidence& e) { e.rate_sums.pop_back(); },
           [](Evidence& e) { e.rate_squares.pop_back(); },
           [](Evidence& e) { e.longest_offsets.clear(); },
           [](Evidence& e) { e.longest_offsets.at(1) = 1000000; },
           [](Evidence& e) { e.longest_gaps.pop_back(); },
           [](Evidence& e) { e.left_out.pop_back(); }, [](Evidence& e) { e.pairs.pop_back(); },
           [](Evidence& e) { e.pairs.at(0).id = 1; },
           [](Evidence& e) { e.pairs.at(0).offsets.at(0) = 1; },
           [](Evidence& e) { e.pairs.at(0).offsets.at(1) = 1000; },
           [](Evidence& e) { e.pairs.at(0).counts.pop_back(); },
           [](Evidence& e) { e.pairs.at(0).answers.push_back(1); }}) {
    EXPECT_EQ(error(change), file + "does not fit its event types");
  }
  EXPECT_EQ(error([](Evidence& e) { e.duration = -1; }), file + "has a negative duration");
  EXPECT_EQ(error([](Evidence& e) { e.gap_sums.at(0) = -1; }), file + "has impossible gaps");
  EXPECT_EQ(error([](Evidence& e) { e.gaps.at(0) = 0; }), file + "has impossible gaps");
  EXPECT_EQ(error([](Evidence& e) { e.pairs.at(0).bins.at(0) = 255; }),
            file + "has an impossible bin");
  EXPECT_EQ(damagedModel([](Message& model) { model.watched.pop_back(); }),
            file + "has not two halves");
}

TEST_F(ModelFileTest, ImpossibleTracksAreRefused) {
  using Message = self_awareness::Model;
  const std::string file = path("damaged") + ": a damaged model file: it watches ";
  EXPECT_EQ(damagedModel([](Message& m) { m.tracks.at(0).channel = self_awareness::Track::DEADLINE + 1; }),
            file + "what this version does not know");
  EXPECT_EQ(damagedModel([](Message& m) { m.tracks.at(0).to_id = 2; }),
            file + "an event type that it does not have");
  EXPECT_EQ(
      damagedModel([](Message& m) { m.tracks.at(0).channel = self_awareness::Track::DELAY; }),
      file + "delays, but not both at present and for longer");
}

TEST_F(ModelFileTest, LimitsOfAnotherModelAreRefused) {
  using Message = self_awareness::Model;
  const std::string told =
      path("damaged") + ": a damaged model file: its limits are not those of its evidence";
  for (const auto change : std::vector<void (*)(self_awareness::EvidenceCalibration&)>{
           [](self_awareness::EvidenceCalibration& c) { c.limits.pop_back(); },
           [](self_awareness::EvidenceCalibration& c) { c.limits.push_back(1); },
           [](self_awareness::EvidenceCalibration& c) { c.limits.clear(); },
           [](self_awareness::EvidenceCalibration& c) { c.linker_limit = std::nan(""); },
           [](self_awareness::EvidenceCalibration& c) { c.linker_limit = 0; }}) {
    const std::string error =
        damagedModel([change](Message& model) { change(model.evidence_calibration.at(0)); });
    EXPECT_EQ(error.rfind(told, 0), 0U) << error;
  }
}

}  // namespace
}  // namespace self_awareness::ros1
