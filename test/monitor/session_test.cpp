#include "monitor/session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "../core/evidence/recordings.h"
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

constexpr std::int64_t kSecond = core::kNanosecondsPerSecond;

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

/// Of a robot whose /b answers /a, with limits.
ros1::TrainedModel modelOfAnswers() {
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
  model.calibration.emplace().limits.tracks.assign(model.watched.tracks.size(), 14);
  return model;
}

MonitorParameters byPaper() {
  MonitorParameters parameters;
  parameters.method = MonitorParameters::Method::kPaper;
  return parameters;
}

ros1::ConnectionEncoder connect(const Session& session, const std::string& topic) {
  return session.encoder()
      ->connect({"/talker", topic, "std_msgs/String", "string data", false, ""})
      .value();
}

std::string serialized(const std::string& data) {
  std::string bytes = std::string("\0\0\0\0", 4) + data;
  bytes[0] = static_cast<char>(data.size());
  return bytes;
}

core::EventId encode(ros1::ConnectionEncoder& connection, const std::string& data) {
  const std::string bytes = serialized(data);
  return connection.id(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

TEST(Session, WhoIsOptionalIsAcceptedAsAbsentBesidesWhatOperatorsAccept) {
  MonitorParameters parameters = byPaper();
  parameters.optional = {"/play*", "/pose"};
  Session session(model(), parameters, [](const core::Verdict& /*verdict*/) {});
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
  EXPECT_NO_THROW(Session(model(), parameters, [](const core::Verdict& /*verdict*/) {}));
  for (std::size_t k = 0; k < core::Acceptances::kMost; ++k) {
    parameters.optional[k] += std::to_string(k);
  }
  EXPECT_THROW(Session(model(), parameters, [](const core::Verdict& /*verdict*/) {}),
               std::invalid_argument);
}

TEST(Session, KnowsTheModelsTopicsAndWhatItsOwnProcessPublishes) {
  const Session session(model(), byPaper(), [](const core::Verdict&) {});
  const LiveSource::Wanted wanted = session.wanted("/manager", 1);
  EXPECT_EQ(wanted.model_topics, (std::set<std::string>{"/pose", "/scan"}));
  const ros1::OwnOutput& own = wanted.own_output;
  EXPECT_FALSE(own.covers("/manager", "/pose")) << "the robot's, by the model";
  EXPECT_TRUE(own.covers("/manager", "/watch/status"));
  EXPECT_FALSE(own.covers("/slam", "/watch/status"));
}

TEST(Session, KnowsTheModelsNamesOfAnotherRobotsNodesAndTopics) {
  ros1::TrainedModel trained = model();
  trained.encoding.renames = {{"/r[0-9]+/(.*)", "/\\1"}};
  Session session(trained, byPaper(), [](const core::Verdict&) {});
  EXPECT_EQ(session.typesOf({"/r7/slam_4242_1600000000000", "/r7/pose"}),
            (std::vector<core::EventId>{1}));
  EXPECT_FALSE(session.wanted("/r7/manager", 1).own_output.covers("/r7/manager", "/r7/pose"));
  ros1::Graph graph;
  graph.topics["/r7/scan"] = {"T", {"/r7/player"}, {"/r7/slam"}};
  session.addEdges(graph, "/r7/self_awareness");
  EXPECT_TRUE(session.graph().hears("/slam", "/player", "/scan"));
}

TEST(Session, IsCalibratedForTheDetectorThatWasChosen) {
  ros1::TrainedModel trained = model();
  EXPECT_FALSE(Session(trained, byPaper(), [](const core::Verdict&) {}).calibrated());
  trained.paper_calibration = core::paper::Calibration();
  trained.paper_calibration->threshold = 0.1;
  EXPECT_TRUE(Session(trained, byPaper(), [](const core::Verdict&) {}).calibrated());
}

TEST(Session, NeedsTheCountsOfItsDetector) {
  EXPECT_THROW(Session(model(), MonitorParameters(), [](const core::Verdict&) {}),
               std::invalid_argument);
  ros1::TrainedModel without = model();
  without.dropCounts();
  EXPECT_THROW(Session(without, byPaper(), [](const core::Verdict&) {}), std::invalid_argument);
}

TEST(Session, JudgesItsWindowsInTurn) {
  std::vector<std::int64_t> starts;
  Session session(model(), byPaper(),
                  [&](const core::Verdict& verdict) { starts.push_back(verdict.window->start); });
  session.detector().add({0, 0});
  session.detector().advance(2 * session.window());
  EXPECT_EQ(starts, (std::vector<std::int64_t>{0, session.window()}));
}

TEST(Session, SaysWhoseDelaysAreNotWatchedNow) {
  Session session(modelOfAnswers(), MonitorParameters(), [](const core::Verdict&) {});
  const std::vector<std::string> words = session.disarmed();
  EXPECT_NE(std::find(words.begin(), words.end(), "/b on /y after /a on /x"), words.end());
  EXPECT_TRUE(Session(model(), byPaper(), [](const core::Verdict&) {}).disarmed().empty());
}

TEST(Session, SaysTheModeThatTheRobotTells) {
  Session session(modelWithModes(), MonitorParameters(), [](const core::Verdict&) {});
  ros1::ConnectionEncoder logic =
      session.encoder()
          ->connect({"/logic", "/state", "std_msgs/String", "string data", false, ""})
          .value();
  const auto tell = [&](std::int64_t stamp, const std::string& mode) {
    const std::string bytes = serialized(mode);
    session.detector().add(
        {stamp, logic.mode(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size())});
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
}

TEST(Session, SaysNoModeWhereNobodyTellsIt) {
  ros1::TrainedModel without = modelWithModes();
  without.encoding.mode.reset();
  EXPECT_EQ(Session(without, MonitorParameters(), [](const core::Verdict&) {}).mode(0), "");
  ros1::TrainedModel of_paper = model();
  of_paper.encoding.mode = ros1::ModeField{"/state", "data"};
  EXPECT_EQ(Session(of_paper, byPaper(), [](const core::Verdict&) {}).mode(0), "")
      << "the paper knows no modes";
}

TEST(Session, EverNewEventTypesDoNotFillTheMemory) {
  const Session session(model(), byPaper(), [](const core::Verdict&) {});
  ros1::ConnectionEncoder connection = connect(session, "/joystick");
  std::set<core::EventId> ids;
  for (std::size_t i = 0; i < 2 * Session::kMostUnknownTypes; ++i) {
    ids.insert(encode(connection, std::to_string(i)));
  }
  EXPECT_EQ(session.vocabulary().size(), session.types().size() + Session::kMostUnknownTypes + 1);
  EXPECT_EQ(session.vocabulary().at(*ids.rbegin()).scope, "(further topics)");
}

}  // namespace
}  // namespace self_awareness
