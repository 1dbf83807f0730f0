#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "../../../problem.h"
#include "../../verdict/accepted.h"
#include "../tracks.h"
#include "core/evidence/presence/news.h"
#include "core/evidence/presence/who_sends.h"
#include "self_awareness/core/evidence/judge.h"
#include "self_awareness/core/stream/listed.h"
#include "self_awareness/core/verdict/alarm.h"
#include "self_awareness/core/verdict/detector.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kPeriod = 200 * kMillisecond;

/// A robot of three; /a also sends what everybody may.
const std::vector<EventType> kRobot{{"/a", "/x", "T"},
                                    {"/b", "/y", "T"},
                                    {"/c", "/z", "T"},
                                    {"/a", "/diagnostics", "D"},
                                    {"/d", "/tf", "F"}};
constexpr EventId kOfAll = 3;
constexpr EventId kFrames = 4;

Events robot(std::int64_t start, std::int64_t length, unsigned seed) {
  return atRandom(kRobot.size(), start, length, kPeriod, seed);
}

class SendersTest : public testing::Test {
 protected:
  SendersTest() {
    for (EventId id = 0; id < kRobot.size(); ++id) {
      limit(kOverdue, id) = 3;
    }
  }
  double& limit(const std::string& channel, EventId id) {
    return ofTrack(limits_.tracks, *model_, channel, id);
  }
  void start() {
    detector_ = std::make_unique<Detector>(
        makeJudge(model_, limits_, kWindow, std::make_shared<SourceGraph>(), heard_), kWindow,
        Detector::Parameters{}, [this](const Verdict& verdict) {
          if (const auto ended = alarms_.add(verdict, kWindow, *heard_)) {
            told_.push_back(*ended);
          }
          is_busy_ = is_busy_ || verdict.busy;
        });
  }
  /// Lets the robot run, with other event types in place of its own.
  void run(std::int64_t from, std::int64_t until, const std::vector<std::optional<EventId>>& ids) {
    for (const Event& event : robot(from, until - from, 300)) {
      if (ids[event.id]) {
        detector_->add({event.stamp, *ids[event.id], event.attributes});
      }
    }
    detector_->advance(until);
  }
  EventId intern(const std::string& source, EventId of) {
    return heard_->intern({source, kRobot[of].scope, kRobot[of].type});
  }
  /// All that was told, with what stands.
  std::vector<Alarm> told() const {
    std::vector<Alarm> all = told_;
    if (alarms_.standing()) {
      all.push_back(*alarms_.standing());
    }
    return all;
  }
  static std::vector<std::string> wordsOf(const Alarm& alarm) {
    std::vector<std::string> words;
    for (const std::vector<Suspect>& suspects : {alarm.suspects, alarm.later}) {
      for (const Suspect& suspect : suspects) {
        words.push_back(suspect.reason.words);
      }
    }
    return words;
  }

  const std::vector<std::optional<EventId>> usual_{0, 1, 2, 3, 4};
  std::shared_ptr<const Model> model_ =
      std::make_shared<Model>(watchAll(countsOf({robot(0, 60 * kSecond, 100)}, kRobot),
                                       countsOf({robot(kStart, 60 * kSecond, 200)}, kRobot)));
  std::shared_ptr<Vocabulary> heard_ = std::make_shared<Vocabulary>(model_->vocabulary());
  Limits limits_ = allLimits(*model_, kNone);
  std::unique_ptr<Detector> detector_;
  Alarms alarms_;
  std::vector<Alarm> told_;
  bool is_busy_ = false;
};

TEST_F(SendersTest, ATopicThatComesFromAnotherNodeIsOneSuspicion) {
  start();
  run(0, 150 * kSecond, {0, intern("/manager", kB), 2, 3, 4});
  ASSERT_EQ(told().size(), 1U);
  const Alarm alarm = told().front();
  EXPECT_EQ(alarm.level, Alarm::Level::kSuspicion);
  EXPECT_FALSE(alarm.over);
  EXPECT_EQ(alarm.kind, Kind::kStranger);
  EXPECT_EQ(alarm.culprit, "/manager");
  ASSERT_EQ(wordsOf(alarm).size(), 1U);
  EXPECT_EQ(alarm.reason,
            "/y comes from /manager now, in training from /b; not watched until you train again "
            "with --rename /manager /b; to accept it: ~accept \"{component: /manager, kind: "
            "stranger}\"");
  alarms_ = {};
  start();
  detector_->accept(allOf({accepted("/manager", "", Kind::kStranger)}));
  run(0, 150 * kSecond, {0, intern("/manager", kB), 2, 3, 4});
  EXPECT_TRUE(told().empty()) << "what is accepted";
}

/// Knows what /d listed in recordings, one list each, and what /a did with values.
class NewsTest : public testing::Test {
 protected:
  using Lists = std::vector<std::set<std::string>>;
  static constexpr char kName[] = "f.name";
  static constexpr char kLevel[] = "status.level";

  static EventType list(const std::set<std::string>& values, const std::string& field = kName) {
    return {"/d", "/tf", typeOfList("F", {field, values})};
  }
  /// Learned from recordings with these.
  static std::shared_ptr<const Model> learnedFrom(const Lists& recordings,
                                                  const std::string& field = kName) {
    Statistics counts = countsOf({robot(0, 20 * kSecond, 7)}, kRobot);
    counts.intern({"/a", "/goal", "G[status=3]"});
    for (const std::set<std::string>& values : recordings) {
      const EventId id = counts.intern(list(values, field));
      std::vector<std::int64_t> firsts(id + 1, -1);
      firsts[id] = 0;
      counts.addRecording({0, 1, 0, 0, std::vector<std::uint64_t>(id + 1), {}, firsts});
    }
    return std::make_shared<const Model>(
        watchAll(counts, countsOf(std::vector<Events>(), counts.vocabulary().types())));
  }
  /// What is said of a list that comes after recordings with these; empty: nothing.
  static std::string said(const Lists& recordings, const EventType& next,
                          const std::string& field = kName) {
    const std::shared_ptr<const Model> model = learnedFrom(recordings, field);
    const auto heard = std::make_shared<Vocabulary>(model->vocabulary());
    const std::optional<Reason> reason = News(*model, heard).reasonOf(heard->intern(next));
    return reason ? reason->words : "";
  }
};

TEST_F(NewsTest, WhatASenderDoesNotListAnyMoreIsToldAndAnotherValue) {
  EXPECT_EQ(said({{"a"}}, {"/a", "/goal", "G[status=4]"}),
            "/a sends /goal with status=4, as never in training");
  EXPECT_EQ(said({{"a"}}, {"/b", "/goal", "G[status=4]"}), "") << "another sender";
  EXPECT_EQ(said({{"a"}}, {"/a", "/other", "G"}), "");
  const Lists twice{{"arm", "laser", "wheel"}, {"arm", "laser", "wheel"}};
  EXPECT_EQ(said(twice, list({"arm", "wheel"})),
            "/d sends /tf without laser (f.name), as never in training");
  EXPECT_EQ(said(twice, list({"arm", "ghost", "laser", "wheel"})),
            "/d sends /tf with f.name=ghost, as never in training");
  EXPECT_EQ(said({{"a", "b"}, {"a", "b"}, {"c", "d"}, {"c", "d"}}, list({"a", "c"})),
            "/d sends /tf with other f.name together, as never in training");
}

TEST_F(NewsTest, WhoListedSomethingOnceMayListOtherThings) {
  EXPECT_EQ(said({{"a", "b"}, {"a", "b"}, {"c", "b"}}, list({"b"})), "");
  EXPECT_EQ(said({{"a", "b"}}, list({"b"})), "") << "one recording tells nothing";
  EXPECT_EQ(said({{}, {}, {"a", "b"}, {"a", "b"}}, list({"b"})), "") << "too many to tell apart";
  EXPECT_EQ(said({{"a", "b"}, {"a", "b"}}, list({})), "");
  EXPECT_EQ(said({{"a", "b"}, {"a", "b"}}, list({"b"}, "g.name")), "") << "of another field";
}

TEST_F(NewsTest, ANewListIsASuspicionWhileItLastsUnlessItIsAccepted) {
  const std::shared_ptr<const Model> model = learnedFrom({{"arm", "laser"}, {"arm", "laser"}});
  const auto heard = std::make_shared<Vocabulary>(model->vocabulary());
  const EventId lacking = heard->intern(list({"arm"}));
  const auto judge =
      makeJudge(model, allLimits(*model, kNone), kWindow, std::make_shared<SourceGraph>(), heard);
  const auto judged = [&](std::int64_t end) {
    Window window;
    window.start = end - kWindow;
    return judge->judge(window, end, NameSuspects::kIfUnusual);
  };
  EXPECT_FALSE(judge->add({kSecond, lacking})) << "it is no message";
  const Judgement news = judged(2 * kSecond);
  EXPECT_TRUE(news.suspicious);
  EXPECT_FALSE(news.abnormal) << "its messages come";
  EXPECT_EQ(news.evidence, "lists");
  ASSERT_EQ(news.suspects.size(), 1U);
  EXPECT_EQ(news.suspects[0].id, lacking);
  const auto isTold = [&](std::int64_t end) {
    return judged(end).evidence.find("lists") != std::string::npos;
  };
  EXPECT_FALSE(isTold(4 * kSecond)) << "it did not come again";
  judge->add({5 * kSecond, lacking});
  EXPECT_TRUE(isTold(6 * kSecond));
  judge->accept(allOf({accepted("/d", "", Kind::kStranger)}));
  judge->add({6 * kSecond, lacking});
  EXPECT_FALSE(isTold(7 * kSecond));
}

TEST_F(NewsTest, WhoSaysSomethingNewExplainsNothingElse) {
  const std::shared_ptr<const Model> model = learnedFrom({{"arm", "laser"}, {"arm", "laser"}});
  const auto heard = std::make_shared<Vocabulary>(model->vocabulary());
  Accepted accepted(model, heard);
  Scorer scorer(model, kWindow);
  scorer.closeWindow(kSecond);
  WhoSends who_sends(model, heard, std::make_shared<SourceGraph>(),
                     std::vector<bool>(model->size(), false));
  who_sends.addList({kSecond, heard->intern(list({"arm"}))}, accepted);
  who_sends.closeWindow(scorer.heard(), accepted);
  EXPECT_EQ(who_sends.alone({}, scorer, false).size(), 1U);
  EXPECT_TRUE(who_sends.causes({}, scorer, 0, {}).empty());
}

TEST_F(NewsTest, ALevelBelowErrorIsTheNodesOwn) {
  const Lists twice{{"0"}, {"0"}};
  EXPECT_EQ(said(twice, list({"1"}, kLevel), kLevel), "");
  EXPECT_EQ(said(twice, list({"2"}, kLevel), kLevel),
            "/d sends /tf with status.level=2, as never in training");
}

TEST_F(SendersTest, ANodeThatWasRenamedIsOneAndSoAreSomeOfItsTopics) {
  start();
  run(0, 100 * kSecond, {intern("/new", kA), 1, 2, intern("/new", kOfAll), intern("/e", kFrames)});
  ASSERT_EQ(told().size(), 1U);
  const std::vector<std::string> words = wordsOf(told().front());
  ASSERT_GE(words.size(), 2U);
  EXPECT_TRUE(begins(words[0], "/tf comes from /e now, in training from /d")) << words[0];
  EXPECT_TRUE(begins(words[1], "/diagnostics and /x come from /new now, in training from /a"))
      << words[1];
}

TEST_F(SendersTest, AManagerThatWasThereMayTakeOverTopicsOfSeveral) {
  start();
  run(0, 100 * kSecond, {intern("/c", kA), intern("/c", kB), 2, 3, 4});
  ASSERT_EQ(told().size(), 1U);
  EXPECT_TRUE(begins(told().front().reason,
                     "/x and /y come from /c now, in training from /a and /b; not watched until "
                     "you train again; to accept it"))
      << told().front().reason;
}

TEST_F(SendersTest, WhatItsNewSenderDiesOfIsNotCalledQuietUnlessTheOldOneComesAfterAll) {
  for (const bool comes_back : {false, true}) {
    alarms_ = {};
    told_.clear();
    start();
    run(0, 30 * kSecond, {0, intern("/manager", kB), 2, 3, 4});
    run(30 * kSecond, 150 * kSecond, {0, comes_back ? usual_[kB] : std::nullopt, 2, 3, 4});
    ASSERT_EQ(told().size(), 1U);
    EXPECT_EQ(told().front().over, comes_back) << "else, nobody watches it";
  }
}

TEST_F(SendersTest, AStrangerAtAnotherRateDoesNotHideWhoNeverCame) {
  start();
  const EventId slow = intern("/joystick", kB);
  const Events all = robot(0, 100 * kSecond, 300);
  std::int64_t next = 0;
  for (const Event& event : all) {
    if (event.id != kB) {
      detector_->add(event);
    } else if (event.stamp >= next) {
      detector_->add({event.stamp, slow});
      next = event.stamp + 5 * kPeriod;
    }
  }
  ASSERT_EQ(told().size(), 2U);
  for (const std::string part : {"never seen in training", "not heard since the start"}) {
    const std::vector<std::string> words = wordsOf(told()[0]);
    EXPECT_TRUE(std::any_of(words.begin(), words.end(),
                            [&](const std::string& each) { return begins(each, part); }))
        << "in the suspicion that stands: " << part;
  }
  EXPECT_EQ(told()[1].level, Alarm::Level::kAlarm);
  EXPECT_EQ(told()[1].culprit, "/b");
  EXPECT_EQ(told()[1].kind, Kind::kNeverCame);
}

TEST_F(SendersTest, TwoSendersOfOneNameAreAnAlarmOfNoComponent) {
  for (EventId id = 0; id < kRobot.size(); ++id) {
    limit(kFaster, id) = 3;
  }
  start();
  run(0, 30 * kSecond, usual_);
  Senders all;
  for (const EventType& type : kRobot) {
    all.doubled.insert({type.source, type.scope});
  }
  detector_->setSenders({{*all.doubled.begin()}, {}});
  const auto twice = [&](std::int64_t from, std::int64_t until, const auto& who) {
    const Events more = without(robot(from, until - from, 500),
                                [&](const Event& event) { return !who(event.id); });
    addAll(*detector_, together({robot(from, until - from, 300), more}));
  };
  twice(30 * kSecond, 32 * kSecond, [](EventId id) { return id == kOfAll; });
  ASSERT_EQ(told().size(), 1U) << "no alarm: a restart may overlap";
  EXPECT_EQ(told()[0].reason, "/diagnostics of /a comes from two senders of one name");
  detector_->setSenders(all);
  twice(32 * kSecond, 60 * kSecond, [](EventId /*id*/) { return true; });
  ASSERT_EQ(told().size(), 2U);
  EXPECT_EQ(told()[0].level, Alarm::Level::kSuspicion);
  const Alarm alarm = told()[1];
  EXPECT_EQ(alarm.level, Alarm::Level::kAlarm);
  EXPECT_EQ(alarm.kind, Kind::kTwoSenders);
  EXPECT_EQ(alarm.culprit, "");
  EXPECT_EQ(alarm.reason, "every topic of 4 nodes comes from two senders of one name");
  EXPECT_EQ(alarm.evidence, "two senders");
  EXPECT_FALSE(is_busy_);
  detector_->setSenders({});
  run(60 * kSecond, 100 * kSecond, usual_);
  EXPECT_EQ(told().size(), 2U) << "what it left behind is no news";
  EXPECT_TRUE(told().back().over);
}

TEST_F(SendersTest, WhatCountedTwiceInTrainingIsNormal) {
  const auto relay = [](std::int64_t from, unsigned seed) {
    Events events = robot(from, 60 * kSecond, seed);
    for (Event& event : events) {
      event.attributes = {
          0, sizeClass(100),
          event.stamp % 2 == 0 ? Attributes::Step::kRestart : Attributes::Step::kLostMany, false};
    }
    return events;
  };
  model_ = std::make_shared<Model>(
      watchAll(countsOf({relay(0, 100)}, kRobot), countsOf({relay(kStart, 200)}, kRobot)));
  limits_ = allLimits(*model_, kNone);
  start();
  detector_->setSenders({{{"/a", "/x"}}, {}});
  run(0, 60 * kSecond, usual_);
  EXPECT_TRUE(told().empty());
}

TEST_F(SendersTest, WhoPlaysOnTopicsOfTheRobotIsTheFirstSuspect) {
  limit(kFaster, kC) = 3;
  start();
  run(0, 30 * kSecond, usual_);
  const EventType scan{"/play_17", "/x", "T"};
  const EventType other{"/play_17", "/y", "T"};
  const EventType unknown{"/play_17", "/new", "T"};
  for (const EventType& type : {scan, other, unknown}) {
    heard_->intern(type);
  }
  detector_->setSenders({{}, {scan, other, unknown}});
  run(30 * kSecond, 40 * kSecond, usual_);
  ASSERT_EQ(told().size(), 1U);
  EXPECT_EQ(told()[0].level, Alarm::Level::kSuspicion);
  EXPECT_EQ(told()[0].culprit, "/play_17");
  EXPECT_EQ(told()[0].reason, "/play_17 plays on 2 topics of this robot: /x and /y");
  for (std::int64_t k = 0; k < 100; ++k) {  // C answers to what is played
    detector_->add({40 * kSecond + k * 20 * kMillisecond, kC});
  }
  run(42 * kSecond, 43 * kSecond, usual_);
  ASSERT_EQ(told().size(), 2U);
  EXPECT_EQ(told()[1].level, Alarm::Level::kAlarm);
  EXPECT_EQ(told()[1].culprit, "/play_17");
  detector_->setSenders({});
  run(43 * kSecond, 60 * kSecond, usual_);
  EXPECT_TRUE(told().back().over);
}

}  // namespace
}  // namespace self_awareness::core::evidence
