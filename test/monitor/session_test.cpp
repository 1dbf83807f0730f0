#include "monitor/session.h"

#include <gtest/gtest.h>
#include <std_msgs/String.h>

#include <algorithm>
#include <stdexcept>

#include "../core/evidence/recordings.h"
#include "../ros/serialized.h"
#include "../times.h"
#include "self_awareness/core/evidence/count/trainer.h"

namespace self_awareness {
namespace {

ros1::TrainedModel model() {
  ros1::TrainedModel model;
  for (const core::EventType& type : {core::EventType{"/player", "/scan", "std_msgs/String"},
                                      core::EventType{"/slam", "/pose", "std_msgs/String"},
                                      core::EventType{"/manager", "/pose", "std_msgs/String"}}) {
    model.statistics.countEvent(model.statistics.intern(type));
  }
  model.encoding.type_fields = {{"std_msgs/String", "data"}};
  model.statistics.pair(0, 0).add(5);
  return model;
}

/// Of a robot that tells its mode.
ros1::TrainedModel modelWithModes() {
  ros1::TrainedModel model;
  model.encoding.mode = ros1::ModeField{"/state", "data"};
  const core::EventId scan = model.statistics.intern({"/player", "/scan", "std_msgs/String"});
  const core::EventId mode =
      model.statistics.intern({"/logic", "/state", "std_msgs/String[mode: DOCKED]"});
  for (core::evidence::Statistics& half : model.evidence) {
    half.intern(model.statistics.vocabulary().at(scan));
    half.intern(model.statistics.vocabulary().at(mode));
    core::evidence::Trainer trainer(half, model.window);
    trainer.add({0, mode});
    for (int i = 0; i < 150; ++i) {
      trainer.add({i * kSecond / 10, scan});
    }
    trainer.finish();
  }
  model.watch();
  return model;
}

/// Of a robot whose /b answers /a.
/// @param limit of all tracks
ros1::TrainedModel modelOfAnswers(double limit) {
  namespace evidence = core::evidence;
  ros1::TrainedModel model;
  for (const core::EventId id : {evidence::kA, evidence::kB}) {
    model.statistics.intern(evidence::kTypes[id]);
  }
  for (unsigned half = 0; half < 2; ++half) {
    const evidence::Events asked =
        evidence::irregular(evidence::kA, 0, 100 * kSecond, kSecond / 5, half);
    model.evidence[half] = evidence::countsOf(
        {evidence::later(
            evidence::together({asked, evidence::answers(evidence::kB, asked, kSecond / 50)}),
            (half + 1) * evidence::kStart)},
        2);
  }
  model.watch();
  model.calibration.emplace().limits.tracks.assign(model.watched.tracks.size(), limit);
  return model;
}

/// Whose verdicts nobody asks for.
struct Quiet : Session {
  explicit Quiet(const ros1::TrainedModel& model, const MonitorParameters& parameters = {})
      : Session(model, parameters, [](const core::Verdict&) {}) {}
};

MonitorParameters paper() {
  MonitorParameters parameters;
  parameters.method = MonitorParameters::Method::kPaper;
  return parameters;
}

struct ByPaper : Quiet {
  explicit ByPaper(const ros1::TrainedModel& model) : Quiet(model, paper()) {}
};

ros1::ConnectionEncoder connect(const Session& session, const std::string& node,
                                const std::string& topic) {
  return session.encoder()
      ->connect({node, topic, "std_msgs/String", "string data", false, ""})
      .value();
}

std::vector<std::uint8_t> message(const std::string& data) {
  std_msgs::String message;
  message.data = data;
  return ros1::serialized(message);
}

TEST(Session, WhoIsOptionalIsAcceptedAsAbsentBesidesWhatOperatorsAccept) {
  MonitorParameters parameters = paper();
  parameters.optional = {"/play*", "/pose"};
  Quiet session(model(), parameters);
  const std::set<std::string> optional = {"/player", "/slam", "/manager"};
  EXPECT_EQ(session.optional(), optional);
  core::Acceptances accepted;
  core::Acceptance slow;
  slow.component = "/slam";
  slow.kind = core::Kind::kSlow;
  accepted.add(slow);
  session.accept(accepted);
  EXPECT_EQ(session.optional(), optional);
  EXPECT_TRUE(session.accepted().mayBeAbsent("/player", "/scan"));
  EXPECT_TRUE(session.accepted().covers("/slam", "/pose", core::Kind::kSlow));
  EXPECT_FALSE(session.accepted().covers("/player", "/scan", core::Kind::kSlow));
  parameters.optional.assign(core::Acceptances::kMost, "/x");
  EXPECT_NO_THROW(Quiet(model(), parameters));
  for (std::size_t k = 0; k < core::Acceptances::kMost; ++k) {
    parameters.optional[k] += std::to_string(k);
  }
  EXPECT_THROW(Quiet(model(), parameters), std::invalid_argument);
}

TEST(Session, KnowsTheModelsNamesOfAnotherRobotsNodesAndTopics) {
  ros1::TrainedModel trained = model();
  trained.encoding.renames = {{"/r[0-9]+/(.*)", "/\\1"}};
  ByPaper session(trained);
  EXPECT_EQ(session.typesOf({"/r7/slam_4242_1600000000000", "/r7/pose"}),
            (std::vector<core::EventId>{1}));
  const LiveSource::Wanted wanted = session.wanted("/r7/manager", 1);
  EXPECT_EQ(wanted.model_topics, (std::set<std::string>{"/pose", "/scan"}));
  EXPECT_FALSE(wanted.own_output.covers("/r7/manager", "/r7/pose")) << "the model knows it";
  EXPECT_TRUE(wanted.own_output.covers("/r7/manager", "/r7/watch/status"));
  ros1::Graph graph;
  graph.topics["/r7/scan"] = {"T", {"/r7/player"}, {"/r7/slam"}};
  graph.hosts = {{"/r7/player", "base"}};
  session.addEdges(graph, "/r7/self_awareness");
  EXPECT_TRUE(session.graph().hears("/slam", "/player", "/scan"));
  EXPECT_EQ(session.graph().hostOf("/player"), "base");
}

TEST(Session, NeedsTheCountsAndTheCalibrationOfItsDetector) {
  ros1::TrainedModel trained = model();
  EXPECT_FALSE(ByPaper(trained).calibrated());
  trained.paper_calibration = core::paper::Calibration();
  trained.paper_calibration->threshold = 0.1;
  EXPECT_TRUE(ByPaper(trained).calibrated());
  EXPECT_THROW(Quiet{model()}, std::invalid_argument);
  ros1::TrainedModel without = model();
  without.dropCounts();
  EXPECT_THROW(ByPaper{without}, std::invalid_argument);
}

TEST(Session, SaysTheModeThatTheRobotTells) {
  Quiet session(modelWithModes());
  ros1::ConnectionEncoder logic = connect(session, "/logic", "/state");
  const auto tell = [&](std::int64_t stamp, const std::string& mode) {
    const std::vector<std::uint8_t> bytes = message(mode);
    session.detector().add({stamp, logic.mode(bytes.data(), bytes.size())});
  };
  EXPECT_EQ(session.mode(0), "not known (/state)");
  tell(10 * kSecond, "DOCKED");
  EXPECT_EQ(session.mode(10 * kSecond), "DOCKED (/state), for 0 s");
  tell(12 * kSecond, "DOCKED");
  EXPECT_EQ(session.mode(15 * kSecond), "DOCKED (/state), for 5 s")
      << "told again, it is the same";
  tell(15 * kSecond, "LO\x1b" + std::string(60, 'S'));
  EXPECT_EQ(session.mode(17 * kSecond),
            "LO\uFFFD" + std::string(55, 'S') + "... (/state), for 2 s, not seen in training");
  session.detector().restart();
  tell(20 * kSecond, "DOCKED");
  session.detector().onMissed(session.typesOf({"/logic", "/state"}), 21 * kSecond);
  EXPECT_EQ(session.mode(22 * kSecond), "not known (/state)") << "another one may have been told";
  EXPECT_EQ(Quiet(modelOfAnswers(14)).mode(0), "") << "nobody tells it";
  ros1::TrainedModel of_paper = model();
  of_paper.encoding.mode = ros1::ModeField{"/state", "data"};
  EXPECT_EQ(ByPaper(of_paper).mode(0), "") << "the paper knows no modes";
}

TEST(Session, SaysWhatIsWatchedLessNow) {
  Quiet session(modelOfAnswers(2));
  const auto says = [&](const std::string& words) {
    const std::vector<std::string> all = session.watchedLess();
    return std::find(all.begin(), all.end(), words) != all.end();
  };
  EXPECT_TRUE(says("/b on /y after /a on /x"));
  for (std::int64_t stamp = 0; stamp < 20 * kSecond; stamp += kSecond / 5) {
    if (stamp < 10 * kSecond || stamp >= 13 * kSecond) {
      session.detector().add({stamp, session.typesOf({"/a", "/x"}).at(0)});
    }
    session.detector().add({stamp, session.typesOf({"/b", "/y"}).at(0)});
  }
  EXPECT_TRUE(says("/a on /x: silent for more than 4.0 s")) << "it has paused for 3.2 s";
  EXPECT_TRUE(ByPaper(model()).watchedLess().empty());
}

}  // namespace
}  // namespace self_awareness
