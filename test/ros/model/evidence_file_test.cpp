// Tests what a model file keeps for the evidence detector.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "model_file_case.h"
#include "self_awareness/Model.h"
#include "self_awareness/ros/model/evidence_message.h"
#include "self_awareness/ros/model/model_bytes.h"
#include "self_awareness/ros/model/tuning_message.h"

namespace self_awareness::ros1 {
namespace {

TEST_F(ModelFileTest, TheEvidenceItsLimitsAndTheGraphComeBackAsTheyWereSaved) {
  TrainedModel model = calibratedModel();
  model.graph.connect("/a", "/x", "/b");
  model.graph.connect("/a", "/y", "/c");
  model.graph.place("/a", "base");
  model.graph.addUnheard({"/planner", "/debug"});
  model.graph.addLasting({"/b", "/x"}, 3);
  model.tuning.least_effect = 0.003;
  model.tuning.share_of_other = 0.8;  // the first and the last one are no exceptions
  model.tuning.fewest_gaps = 31;
  model.tuning.without = {"fewer", "own gaps"};
  ASSERT_GE(model.calibration->limits.tracks.size(), 6U);
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
  EXPECT_TRUE(loaded.tuning == model.tuning);
  EXPECT_TRUE(loaded.watched.tuning == model.tuning);
  EXPECT_EQ(loaded.graph.edges().size(), 2U);
  EXPECT_TRUE(loaded.graph.edges() == model.graph.edges());
  EXPECT_EQ(loaded.graph.hostOf("/a"), "base");
  EXPECT_EQ(loaded.unheard(), (std::set<core::SourceGraph::Publication>{{"/planner", "/debug"}}));
  EXPECT_EQ(loaded.graph.lasting(), model.graph.lasting());
  const core::evidence::Limits limits = loaded.limits().value();
  ASSERT_EQ(limits.tracks.size(), model.calibration->limits.tracks.size());
  EXPECT_TRUE(std::isnan(limits.tracks[0]));
  EXPECT_EQ(limits.tracks[1], 2.5);
  EXPECT_EQ(loaded.calibration->method, "held-out");
  EXPECT_EQ(loaded.calibration->budget, 0.25);
  EXPECT_EQ(loaded.calibration->windows, 1234U);
  EXPECT_EQ(loaded.calibration->recordings.at(0).bag, "normal.bag");
  EXPECT_FALSE(loadModel([this] {
                 saveModel(someModel(), path("bare"));
                 return path("bare");
               }())
                   .limits());
}

TEST_F(ModelFileTest, HowLongTheMachineStoodStillComesBack) {
  TrainedModel model = someModel();
  core::evidence::Statistics::Recording recording = model.evidence[0].recordings().at(0);
  ++recording.start;
  recording.longest_stall = 1200000000;
  model.evidence[0].addRecording(recording);
  model.watched.halves[0].addRecording(recording);
  saveModel(model, path("m"));
  const TrainedModel loaded = loadModel(path("m"));
  EXPECT_TRUE(loaded.evidence[0] == model.evidence[0]);
  EXPECT_EQ(loaded.evidence[0].recordings().at(0).longest_stall, 0);
  EXPECT_EQ(loaded.evidence[0].recordings().at(1).longest_stall, 1200000000);
}

TEST_F(ModelFileTest, PairsThatWereLeftOutForGoodComeBackAsSuch) {
  TrainedModel model = calibratedModel();
  core::evidence::PairSet pairs;
  pairs.add(1, 0);
  for (core::evidence::Statistics& half : model.evidence) {
    half = half.without(pairs);
  }
  saveModel(model, path("m"));
  for (const TrainedModel& loaded : {loadModel(path("m")), fromBytes(toBytes(model))}) {
    EXPECT_TRUE(loaded.evidence == model.evidence);
    EXPECT_TRUE(loaded.evidence[0].leftOut() == pairs);
    EXPECT_EQ(loaded.evidence[1].delaysToAny(), model.watched.halves[1].delaysToAny());
  }
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
  EXPECT_EQ(loaded.calibration->false_alarms_per_hour, 0.125);
  const std::vector<core::evidence::Relation>& relations = loaded.calibration->relations;
  ASSERT_EQ(relations.size(), model.watched.tracks.size());
  for (std::size_t track = 0; track < relations.size(); ++track) {
    const core::evidence::Relation& relation = relations[track];
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
  for (const auto change :
       std::vector<void (*)(Findings&)>{[](Findings& f) { f.part_windows.push_back(1); },
                                        [](Findings& f) { f.evidence.pop_back(); },
                                        [](Findings& f) { f.longest_gaps.push_back(1); },
                                        [](Findings& f) { f.said.pop_back(); }}) {
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

TEST_F(ModelFileTest, AnImpossibleTuningIsRefused) {
  using Message = self_awareness::Model;
  const std::string file = path("damaged") + ": a damaged model file: ";
  EXPECT_EQ(damagedModel([](Message& m) {
              std::vector<std::string>& names = m.tuning.names;
              const auto name = std::find(names.begin(), names.end(), "least_effect");
              m.tuning.values.at(static_cast<std::size_t>(name - names.begin())) = -0.001;
            }),
            file + "least_effect must be from 0 to 1000 s, not -0.001");
  EXPECT_EQ(damagedModel([](Message& m) { m.tuning.values.pop_back(); }),
            file + "its tuning has names without numbers");
}

TEST(TuningMessage, WhatIsMissingHasItsDefaultAndWhatIsUnknownIsLeftOut) {
  self_awareness::Model message;
  message.tuning.names = {"of_tomorrow", "least_effect"};
  message.tuning.values = {-7, 0.003};
  message.tuning.without = {"of tomorrow", "fewer"};
  core::evidence::Tuning expected;
  expected.least_effect = 0.003;
  expected.rare_misses = 1;  // it had no such rule
  expected.without = {"fewer"};
  EXPECT_TRUE(tuningOf(message) == expected);
}

TEST(TuningMessage, AFileOfFormat1HasThreeNumbers) {
  self_awareness::Model message;
  message.predecessors = 5;
  message.least_effect = 7e6;  // [ns]
  message.least_effect_of_period = 0.01;
  core::evidence::Tuning expected;
  expected.predecessors = 4;  // besides its own gaps
  expected.least_effect = 0.007;
  expected.least_effect_of_period = 0.01;
  expected.rare_misses = 1;
  EXPECT_TRUE(tuningOf(message) == expected);
  message.least_effect = -1e6;
  EXPECT_THROW(tuningOf(message), std::invalid_argument);
}

TEST_F(ModelFileTest, ImpossibleTracksAreRefused) {
  using Message = self_awareness::Model;
  EXPECT_EQ(
      damagedModel([](Message& m) { m.tracks.at(0).to_id = 2; }),
      path("damaged") + ": a damaged model file: it watches an event type that it does not have");
}

TEST_F(ModelFileTest, WhatThisVersionDoesNotKnowIsNotWatchedAndAllElseIs) {
  const TrainedModel whole = calibratedModel();
  ASSERT_EQ(damagedModel([](self_awareness::Model& m) { m.tracks.at(1).name = "smell"; }), "");
  const TrainedModel model = loadModel(path("damaged"));
  ASSERT_EQ(model.watched.tracks.size() + 1, whole.watched.tracks.size());
  EXPECT_EQ(model.limits()->tracks.size(), model.watched.tracks.size());
  EXPECT_TRUE(std::isnan(model.limits()->tracks[0]));
  EXPECT_EQ(model.limits()->tracks[1], 2.5);
  EXPECT_EQ(model.calibration->relations.size(), model.watched.tracks.size());
  for (std::size_t k = 0; k < model.findings.size(); ++k) {
    const core::evidence::LimitFinder::Recording& all = whole.findings[k];
    const core::evidence::LimitFinder::Recording& left = model.findings[k];
    EXPECT_EQ(left.said[0], all.said[0]);
    EXPECT_EQ(left.said[1], all.said[2]);
    for (std::size_t part = 0; part < all.parts.size(); ++part) {
      EXPECT_EQ(left.parts[part].evidence[1], all.parts[part].evidence[2]);
    }
  }
  saveModel(model, path("again"));
  EXPECT_EQ(loadModel(path("again")).watched.tracks.size(), model.watched.tracks.size());
}

TEST_F(ModelFileTest, LimitsOfAnotherModelAreRefused) {
  using Message = self_awareness::Model;
  const std::string told =
      path("damaged") + ": a damaged model file: its limits are not those of its evidence";
  for (const auto change : std::vector<void (*)(self_awareness::EvidenceCalibration&)>{
           [](self_awareness::EvidenceCalibration& c) { c.limits.pop_back(); },
           [](self_awareness::EvidenceCalibration& c) { c.limits.push_back(1); },
           [](self_awareness::EvidenceCalibration& c) { c.limits.clear(); }}) {
    const std::string error =
        damagedModel([change](Message& model) { change(model.evidence_calibration.at(0)); });
    EXPECT_EQ(error.rfind(told, 0), 0U) << error;
  }
}

}  // namespace
}  // namespace self_awareness::ros1
