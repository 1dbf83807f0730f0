// What a model of another version watches and this one does not know is removed, with all that is
// said of it.

#include "ros/model/model_upgrade.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "model_file_case.h"
#include "self_awareness/core/evidence/channel/track.h"
#include "self_awareness/ros/file_version.h"

namespace self_awareness::ros1 {
namespace {

using self_awareness::Track;

/// Channels as this version knows them.
std::set<std::string> knownChannels() {
  const std::vector<std::string> names = core::evidence::channelNames();
  return {names.begin(), names.end()};
}

/// As a file of format 1 has it.
Track numbered(std::uint8_t channel, std::uint32_t to, std::uint32_t from) {
  Track track;
  track.channel = channel;
  track.to_id = to;
  track.from_id = from;
  return track;
}

/// The model of the case, with a track of an unknown channel before each other one.
self_awareness::Model withUnknownTracks(const TrainedModel& model) {
  self_awareness::Model message = toMessage(model);
  Track unknown;
  unknown.name = "smell";
  for (std::size_t k = message.tracks.size(); k-- > 0;) {
    message.tracks.insert(message.tracks.begin() + static_cast<std::ptrdiff_t>(k), unknown);
    auto& calibration = message.evidence_calibration.at(0);
    calibration.limits.insert(calibration.limits.begin() + static_cast<std::ptrdiff_t>(k), 99);
    calibration.relations.insert(calibration.relations.begin() + static_cast<std::ptrdiff_t>(k),
                                 self_awareness::Relation());
  }
  for (self_awareness::RecordingFindings& findings : message.findings) {
    std::vector<float> evidence;
    for (const float each : findings.evidence) {
      evidence.insert(evidence.end(), {77, each});
    }
    findings.evidence = evidence;
    std::vector<std::uint8_t> said;
    for (const std::uint8_t each : findings.said) {
      said.insert(said.end(), {0, each});
    }
    findings.said = said;
  }
  return message;
}

class ModelUpgradeTest : public ModelFileTest {
 protected:
  static std::string errorOf(self_awareness::Model message) {
    try {
      removeOtherTracks(message, knownChannels());
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(ModelUpgradeTest, TracksOfOtherChannelsGoWithAllThatIsSaidOfThem) {
  const TrainedModel model = calibratedModel();
  self_awareness::Model message = withUnknownTracks(model);
  ASSERT_EQ(message.tracks.size(), 2 * model.watched.tracks.size());
  const std::set<std::string> left_out = upgrade(message, kModelFile.format);
  EXPECT_EQ(left_out.size(), 1U);
  const self_awareness::Model expected = toMessage(model);
  EXPECT_EQ(message.tracks, expected.tracks);
  EXPECT_EQ(message.findings, expected.findings);
  EXPECT_EQ(message.evidence_calibration.at(0).relations,
            expected.evidence_calibration.at(0).relations);
  const std::vector<double>& limits = message.evidence_calibration.at(0).limits;
  ASSERT_EQ(limits.size(), model.watched.tracks.size());
  EXPECT_TRUE(std::isnan(limits[0]));
  EXPECT_EQ(std::vector<double>(limits.begin() + 1, limits.end()),
            std::vector<double>(limits.size() - 1, 2.5));
  EXPECT_NO_THROW(fromMessage(message));
}

TEST_F(ModelUpgradeTest, NamesThatEarlierVersionsTookFromBagsAreWhole) {
  TrainedModel model = someModel();
  const core::Vocabulary whole = model.vocabulary();
  const auto rename = [&](const core::Vocabulary& types) {
    model.statistics.rename(types);
    for (core::evidence::Statistics& half : model.evidence) {
      half.rename(types);
    }
  };
  rename(core::Vocabulary({{"/a", "x", "T"}, {"b", "//y", "T[action=1]"}}));
  model.graph.connect("a", "x", "/b");
  model.graph.place("a", "base");
  model.graph.addUnheard({"a", "debug"});
  model.graph.addLasting({"b", "x"});
  saveModel(model, path("typed.model"));
  const TrainedModel loaded = loadModel(path("typed.model"));
  EXPECT_EQ(loaded.vocabulary().types(), whole.types());
  EXPECT_TRUE(loaded.graph.hears("/b", "/a", "/x"));
  EXPECT_EQ(loaded.graph.hostOf("/a"), "base");
  EXPECT_EQ(loaded.graph.unheard().count({"/a", "/debug"}), 1U);
  EXPECT_EQ(loaded.graph.lasting().count({"/b", "/x"}), 1U);

  rename(core::Vocabulary({{"/a", "/x", "T"}, {"/a", "x", "T"}}));
  saveModel(model, path("twice.model"));
  const std::string error = modelError(path("twice.model"));
  EXPECT_NE(error.find("the topic /x twice"), std::string::npos) << error;
}

TEST_F(ModelUpgradeTest, AnyChannelMayGo) {
  for (const std::string& gone : knownChannels()) {
    std::set<std::string> channels = knownChannels();
    channels.erase(gone);
    self_awareness::Model message = toMessage(calibratedModel());
    const auto is_gone = [&](const Track& track) { return track.name == gone; };
    const auto going = static_cast<std::size_t>(
        std::count_if(message.tracks.begin(), message.tracks.end(), is_gone));
    const std::size_t before = message.tracks.size();
    removeOtherTracks(message, channels);
    EXPECT_EQ(message.tracks.size(), before - going);
    EXPECT_TRUE(std::none_of(message.tracks.begin(), message.tracks.end(), is_gone));
    EXPECT_EQ(message.evidence_calibration.at(0).limits.size(), before - going);
    EXPECT_EQ(message.evidence_calibration.at(0).relations.size(), before - going);
    EXPECT_EQ(message.findings.at(1).evidence.size(), 2 * (before - going));
    EXPECT_EQ(message.findings.at(1).said.size(), before - going);
  }
}

TEST_F(ModelUpgradeTest, AllMayGo) {
  self_awareness::Model message = toMessage(calibratedModel());
  removeOtherTracks(message, {});
  EXPECT_TRUE(message.tracks.empty());
  EXPECT_TRUE(message.findings.at(1).evidence.empty());
}

TEST_F(ModelUpgradeTest, ChannelsHadNumbersInFormat1) {
  self_awareness::Model message;
  message.tracks = {numbered(0, 0, 0), numbered(1, 0, 0), numbered(2, 0, 0),
                    numbered(3, 0, 0), numbered(3, 1, 0), numbered(6, 1, 0)};
  upgrade(message, 1);
  std::vector<std::string> names;
  for (const Track& track : message.tracks) {
    names.push_back(track.name);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"overdue", "fewer", "more", "own gaps", "pairs",
                                             "deadlines"}));
}

TEST_F(ModelUpgradeTest, SlowDelaysAndAnswersOfFormat1AreLeftOut) {
  self_awareness::Model message;
  message.tracks = {numbered(4, 1, 0), numbered(0, 1, 1), numbered(5, 1, 0), numbered(200, 1, 0)};
  EXPECT_EQ(upgrade(message, 1), (std::set<std::string>{"answers", "channel 200", "slow delays"}));
  ASSERT_EQ(message.tracks.size(), 1U);
  EXPECT_EQ(message.tracks[0].name, "overdue");
}

TEST_F(ModelUpgradeTest, BetweenProcessesNothingIsUnknown) {
  EXPECT_THROW(fromMessage(withUnknownTracks(calibratedModel())), std::invalid_argument);
}

TEST_F(ModelUpgradeTest, ColumnsThatDoNotFitTheTracksAreRefused) {
  const self_awareness::Model whole = withUnknownTracks(calibratedModel());
  ASSERT_EQ(errorOf(whole), "");
  for (const auto damage : std::vector<void (*)(self_awareness::Model&)>{
           [](self_awareness::Model& m) { m.findings.at(0).evidence.pop_back(); },
           [](self_awareness::Model& m) { m.findings.at(0).said.clear(); },
           [](self_awareness::Model& m) { m.findings.at(1).part_windows.push_back(1); },
           [](self_awareness::Model& m) { m.evidence_calibration.at(0).limits.pop_back(); },
           [](self_awareness::Model& m) { m.evidence_calibration.at(0).relations.pop_back(); }}) {
    self_awareness::Model damaged = whole;
    damage(damaged);
    EXPECT_NE(errorOf(damaged), "");
  }
}

}  // namespace
}  // namespace self_awareness::ros1
