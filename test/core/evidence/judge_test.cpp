#include "self_awareness/core/evidence/judge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "../verdict/accepted.h"
#include "judged.h"
#include "tracks.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kPeriod = 200 * kMillisecond;

class EvidenceJudgeTest : public testing::Test {
 protected:
  // Only what a test gives a limit is judged.
  double& limit(const std::string& channel, EventId to, EventId from) {
    return ofTrack(limits_.tracks, *model_, channel, to, from);
  }
  double& limit(const std::string& channel, EventId id) { return limit(channel, id, id); }
  std::unique_ptr<core::Judge> newJudge(const std::optional<Limits>& limits) const {
    return makeJudge(model_, limits, kWindow, graph_, heard_);
  }
  /// Begins anew, and hears events.
  void start(const Events& heard = {}) {
    judge_ = newJudge(limits_);
    addAll(*judge_, heard);
  }
  /// Judges the window that ends then [ns].
  Judgement at(std::int64_t end, NameSuspects suspects = NameSuspects::kIfUnusual) {
    return judge_->judge({end - kWindow, {}}, end, suspects);
  }
  // Adds answers as in training, so that all tracks count, and then late ones.
  void feed(int late) {
    for (int i = 0; i < 40 + late; ++i) {
      const std::int64_t delay = i < 40 ? 20 * kMillisecond : 70 * kMillisecond;
      judge_->add({i * kPeriod, kA});
      judge_->add({i * kPeriod + delay, kB});
    }
  }
  /// Judges a window in which the machine is starved.
  Judgement starvedAt(std::int64_t start) {
    judge_->hear({start, start + kWindow, kWindow});
    return at(start + kWindow);
  }

  std::shared_ptr<const Model> model_ =
      std::make_shared<Model>(watchAll(startOf(followed(1), 1, 2), startOf(followed(2), 2, 2)));
  std::shared_ptr<Vocabulary> heard_;  // what is heard; none: what the model knows
  std::shared_ptr<SourceGraph> graph_ = std::make_shared<SourceGraph>();
  Limits limits_ = allLimits(*model_, kNone);
  std::unique_ptr<core::Judge> judge_;
};

TEST_F(EvidenceJudgeTest, TheScoreIsTheLargestShareOfALimit) {
  const std::int64_t age = 700 * kMillisecond;
  for (const double share : {0.5, 0.99, 1.01}) {
    limit(kOverdue, kA) = toSeconds(age) / share;
    start({{0, kA}});
    const Judgement judgement = at(age);
    EXPECT_NEAR(judgement.score.value(), -share, 1e-12);
    EXPECT_EQ(judgement.threshold, -1);
    EXPECT_EQ(judgement.abnormal, share > 1);
    EXPECT_EQ(judgement.evidence, share > 1 ? "overdue" : "");
    EXPECT_FALSE(judgement.certain);
    EXPECT_FALSE(judgement.suspicious);
  }
}

TEST_F(EvidenceJudgeTest, SaysWhatIsWatchedLessNow) {
  EXPECT_TRUE(newJudge(std::nullopt)->watchedLess().empty()) << "nothing is judged";
  EXPECT_TRUE(newJudge(limits_)->watchedLess().empty()) << "no limit, not judged";
  limit(kPairs, kB, kA) = 14;
  start();
  ASSERT_EQ(judge_->watchedLess().size(), 1U);
  EXPECT_EQ(judge_->watchedLess()[0].id, kB);
  EXPECT_EQ(judge_->watchedLess()[0].after, kA);
  feed(0);
  EXPECT_TRUE(judge_->watchedLess().empty());
}

TEST_F(EvidenceJudgeTest, ASilenceThatHasLastedIsCertain) {
  limit(kOverdue, kA) = 1;
  start({{0, kA}});
  EXPECT_FALSE(at(kSecond).abnormal);
  const Judgement soon = at(kSecond + 50 * kMillisecond);
  EXPECT_TRUE(soon.abnormal);
  EXPECT_FALSE(soon.certain);
  EXPECT_TRUE(at(kSecond + 101 * kMillisecond).certain);
}

TEST_F(EvidenceJudgeTest, OfAStarvedMachineNobodyIsNamed) {
  limit(kOverdue, kA) = 1.2;
  start({{-100 * kSecond, kA}, {-100 * kSecond, kB}, {0, kA}});
  judge_->hear({-100 * kSecond, 0, 0});
  Judgement judgement;
  std::int64_t now = 0;
  const auto starve = [&](std::int64_t until) {
    for (; now < until; now += kWindow) {
      judgement = starvedAt(now);
    }
  };
  starve(1800 * kMillisecond);
  EXPECT_FALSE(judgement.abnormal) << "what it waited is forgiven";
  ASSERT_TRUE(judgement.busy);
  EXPECT_TRUE(judgement.suspicious);
  EXPECT_EQ(judgement.evidence, "busy");
  EXPECT_TRUE(judgement.suspects.empty());
  starve(2 * kSecond);
  EXPECT_TRUE(judgement.abnormal) << "what is forgiven is no more than a stall";
  EXPECT_TRUE(judgement.suspects.empty()) << "but held up";
  starve(6 * kSecond);
  EXPECT_EQ(idsOf(judgement.suspects), Ids{kA});
}

TEST_F(EvidenceJudgeTest, AMachineThatStaysStarvedIsAnAlarm) {
  limit(kOverdue, kA) = 1;
  start({{-100 * kSecond, kB}});
  judge_->hear({-100 * kSecond, 0, 0});
  for (std::int64_t now = 0; now < 62 * kSecond; now += kWindow) {
    judge_->add({now, kA});
    judge_->add({now, kB});
    const Judgement judgement = starvedAt(now);
    EXPECT_EQ(judgement.suspicious, now >= 1700 * kMillisecond) << toSeconds(now);
    if (now != 60 * kSecond - kWindow) {  // a minute, to the last digit
      EXPECT_EQ(judgement.abnormal, now >= 60 * kSecond) << toSeconds(now);
    }
    EXPECT_TRUE(judgement.suspects.empty());
  }
}

TEST_F(EvidenceJudgeTest, WhoSaysAnotherThingIsNotSilent) {
  // /a says two things in turn, and /b one.
  const auto trained = [](std::int64_t from) {
    return countsOf({together({timer(0, from, from + 100 * kSecond, kSecond),
                               timer(1, from + kSecond / 2, from + 100 * kSecond, kSecond),
                               timer(2, from, from + 100 * kSecond, kPeriod)})},
                    {{"/a", "/x", "T"}, {"/a", "/w", "T"}, {"/b", "/y", "T"}});
  };
  model_ = std::make_shared<Model>(watch(trained(0), trained(kStart)));
  limits_ = allLimits(*model_, kNone);
  for (EventId id = 0; id < 3; ++id) {
    limit(kOverdue, id) = 2;
  }
  start({{0, 2}, {kSecond, 0}, {2500 * kMillisecond, 1}});
  const Judgement judgement = at(2800 * kMillisecond);  // /x should have come 0.8 s ago
  EXPECT_TRUE(judgement.abnormal);
  EXPECT_FALSE(judgement.silent);
  judge_->add({2900 * kMillisecond, 2});
  EXPECT_TRUE(at(6 * kSecond).silent);
}

TEST_F(EvidenceJudgeTest, NamesSuspectsOnlyWhereTheyAreAskedFor) {
  limit(kOverdue, kA) = 1;
  start({{0, kA}});
  const Window unknown{0, {{{0, kC}, true, {}}}};
  EXPECT_TRUE(judge_->judge(unknown, kPeriod, NameSuspects::kIfUnusual).suspects.empty());
  EXPECT_EQ(judge_->judge(unknown, kPeriod, NameSuspects::kAlways).suspects.size(), 1U);
  // A is near its limit, but within its own range.
  const Judgement beside = judge_->judge(unknown, 960 * kMillisecond, NameSuspects::kAlways);
  EXPECT_GT(-*beside.score, model_->tuning().near_limit);
  EXPECT_FALSE(beside.abnormal);
  EXPECT_EQ(idsOf(beside.suspects), Ids{kC});
  EXPECT_TRUE(at(2 * kSecond, NameSuspects::kNever).suspects.empty());
  EXPECT_EQ(at(2 * kSecond, NameSuspects::kIfUnusual).suspects.size(), 1U);
  EXPECT_TRUE(newJudge(std::nullopt)->judge(unknown, 0, NameSuspects::kAlways).suspects.empty());
}

TEST_F(EvidenceJudgeTest, WithoutLimitsItSaysNothingAndThoseOfAnotherModelAreRefused) {
  judge_ = newJudge(std::nullopt);
  judge_->add({0, kA});
  const Judgement judgement = at(3000 * kSecond);
  EXPECT_FALSE(judgement.score || judgement.threshold);
  EXPECT_FALSE(judgement.abnormal || judgement.certain || judgement.suspicious);
  limits_.tracks.pop_back();
  EXPECT_THROW(newJudge(limits_), std::invalid_argument);
}

TEST_F(EvidenceJudgeTest, WhatIsAcceptedIsNoEvidenceAndAllElseIs) {
  limit(kOverdue, kA) = 1;
  limit(kOverdue, kB) = 1;
  limit(kSlower, kB) = 2;
  const auto judgedWith = [&](const Acceptances& all) {
    start();
    for (int i = 0; i < 40; ++i) {
      judge_->add({i * kPeriod, kA});
      judge_->add({i * kPeriod + 20 * kMillisecond, kB});
      at(i * kPeriod + kWindow);
    }
    judge_->accept(all);
    return at(40 * kPeriod + 3 * kSecond);
  };
  EXPECT_TRUE(judgedWith({}).silent) << "all are";
  const Judgement still_silent = judgedWith(allOf({accepted("/b", "", Kind::kSlow)}));
  EXPECT_EQ(still_silent.evidence, "overdue") << "its rate is accepted, its silence is not";
  EXPECT_TRUE(still_silent.silent);
  const Judgement of_a = judgedWith(allOf({accepted("/b")}));
  EXPECT_TRUE(of_a.abnormal) << "another one is silent, too";
  EXPECT_EQ(idsOf(of_a.suspects), Ids{kA});
  const Judgement normal =
      judgedWith(allOf({accepted("/b"), accepted("/a*", "/x", Kind::kSilent)}));
  EXPECT_EQ(normal.score.value(), 0);
}

TEST_F(EvidenceJudgeTest, WhoIsOptionalMayBeAbsentAndIsJudgedWhileThere) {
  limit(kOverdue, kB) = 1;
  limit(kSlower, kB) = 4;
  start();
  judge_->accept(allOf({accepted("/b", "", Kind::kNeverCame)}));
  judge_->settle({0, kB}, kSecond);
  const auto play = [&](int from, int to, int every) {  // B answers every so many times
    double worst = 0;
    for (int i = from; i < to; ++i) {
      judge_->add({i * kPeriod, kA});
      if (every > 0 && i % every == 0) {
        judge_->add({i * kPeriod + 20 * kMillisecond, kB});
      }
      for (int window = 1; window <= 2; ++window) {
        worst = std::min(worst, at(i * kPeriod + window * kWindow).score.value());
      }
    }
    return worst;
  };
  EXPECT_GT(play(0, 40, 1), -1) << "it is there";
  const std::int64_t gone = model_->longestGap(kB) / kPeriod;
  EXPECT_GT(play(40, 120, 0), -1) << "absent, for longer than " << gone << " periods";
  EXPECT_GT(play(120, 160, 1), -1) << "back";
  EXPECT_LT(play(160, 200, 5), -1) << "there, and slow";
}

TEST_F(EvidenceJudgeTest, WhatSettlesOrWasMissedIsNotJudgedAndAllElseIs) {
  limit(kOverdue, kA) = 1;
  limit(kPairs, kB, kA) = 1;
  const std::int64_t now = 45 * kPeriod;
  for (const bool missed : {false, true}) {
    const auto evidenceAt = [&](std::int64_t begin, EventId id, std::int64_t until) {
      start();
      if (missed) {
        judge_->leaveOut({id}, until);
        judge_->leaveOut({id}, until - kSecond);  // it was left out for longer before
      } else {
        judge_->settle({until - kSecond, id}, kSecond);
      }
      feed(5);
      const Judgement judgement =
          judge_->judge({begin, {}}, now + 3 * kSecond, NameSuspects::kNever);
      EXPECT_FALSE(judgement.settling);
      return judgement.evidence;
    };
    EXPECT_EQ(evidenceAt(now, kB, now + 1), "overdue") << "its pair with A is left out";
    EXPECT_EQ(evidenceAt(now, kB, now), "overdue") << "and what it has said so far";
    EXPECT_EQ(evidenceAt(now, kA, now + 1), "");
    EXPECT_EQ(evidenceAt(now, kC, now + 1), "overdue, pairs") << "unknown to the model";
  }
}

TEST_F(EvidenceJudgeTest, WhoWasSilentBeforeThisProgramStoodStillIsSilentStill) {
  limit(kOverdue, kA) = 1;
  limit(kPairs, kB, kA) = 1;
  start();
  feed(5);
  const std::int64_t last = 44 * kPeriod;  // of A, which dies
  const std::int64_t resumed = last + 10 * kSecond;
  EXPECT_EQ(at(last + kWindow).evidence, "pairs");
  judge_->standStill({last + kWindow, resumed, resumed - last - kWindow}, resumed + 3 * kSecond);
  judge_->add({last + 80 * kMillisecond, kB});  // waited in a queue
  EXPECT_FALSE(at(last + 5 * kSecond).abnormal) << "a window in which nobody listened";
  judge_->add({resumed, kB});
  EXPECT_FALSE(at(resumed + 800 * kMillisecond).abnormal) << "what else was unusual settles";
  EXPECT_FALSE(at(resumed + kSecond).abnormal) << "loops may have another phase";
  const Judgement found = at(resumed + 1100 * kMillisecond);
  EXPECT_EQ(found.evidence, "overdue");
  ASSERT_EQ(idsOf(found.suspects), Ids{kA});
  EXPECT_GT(found.suspects[0].reason.value, 10) << "for so long it was not heard";
}

TEST_F(EvidenceJudgeTest, AfterARestartAllBeginsAnew) {
  limit(kOverdue, kA) = 1;
  start();
  judge_->settle({0, kA}, 1000 * kSecond);
  judge_->add({0, kA});
  EXPECT_FALSE(at(100 * kSecond).abnormal);
  judge_->restart();
  EXPECT_FALSE(at(200 * kSecond).abnormal) << "nor is known what was heard";
  judge_->add({0, kA});
  EXPECT_TRUE(at(100 * kSecond).abnormal);
}

TEST_F(EvidenceJudgeTest, WhoDoesNotSubscribeIsASuspicionAndHidesNobody) {
  limit(kOverdue, kA) = 100;
  start({{0, kA}, {0, kB}});
  judge_->setMissing({{"/b", "/x"}});
  EXPECT_FALSE(at(kSecond).suspicious);
  const Judgement missing = at(62 * kSecond);
  EXPECT_TRUE(missing.suspicious);
  EXPECT_FALSE(missing.abnormal);
  EXPECT_EQ(missing.evidence, "connections");
  EXPECT_EQ(idsOf(missing.suspects), Ids{kB}) << "kA is near its limit, and no more";
  judge_->accept(allOf({accepted("/b", "/x", Kind::kUnsubscribed)}));
  EXPECT_FALSE(at(63 * kSecond).suspicious);
  judge_->accept({});
  const Judgement death = at(101 * kSecond);
  EXPECT_TRUE(death.abnormal);
  ASSERT_EQ(idsOf(death.suspects), (Ids{kA, kB}));
  EXPECT_EQ(death.suspects[1].reason.kind, Kind::kUnsubscribed);
  judge_->setMissing({});
  EXPECT_FALSE(at(102 * kSecond).suspicious);
}

class EvidenceJudgeOfStrangersTest : public EvidenceJudgeTest {
 protected:
  EvidenceJudgeOfStrangersTest() {
    heard_ = std::make_shared<Vocabulary>(model_->vocabulary());
    stranger_ = heard_->intern({"/rostopic", "/y", "T"});
  }
  bool isUnknown(std::int64_t stamp, EventId id) { return judge_->add({stamp, id})->unknown; }
  // Whether it is news that a node logs, at a level.
  bool isNews(const std::string& source, const std::string& level, std::int64_t stamp = kSecond) {
    return isUnknown(stamp, heard_->intern({source, "/rosout", "rosgraph_msgs/Log" + level}));
  }
  std::vector<Suspect> suspectsIn(const Window& window) {
    return judge_->judge(window, window.start + kWindow, NameSuspects::kIfUnusual).suspects;
  }
  /// Who is named while kB comes far too often, and an unknown type in each window.
  /// @param heard before
  std::vector<Suspect> whileFast(EventId unknown, const Events& heard = {}) {
    limit(kFaster, kB) = 3;
    start(heard);
    std::vector<Suspect> named;
    for (std::int64_t now = 0; now < 5 * kSecond; now += kWindow) {
      Window window{now, {}};
      for (int i = 0; i < 5; ++i) {
        window.events.push_back(*judge_->add({now + i * kMillisecond, kB}));
      }
      window.events.push_back(*judge_->add({now + kWindow / 2, unknown}));
      named = suspectsIn(window);
    }
    return named;
  }

  EventId stranger_ = 0;
};

TEST_F(EvidenceJudgeOfStrangersTest, AnUnknownSenderOnAKnownTopicIsTheFirstSuspectOfARate) {
  const std::vector<Suspect> named = whileFast(stranger_);
  ASSERT_GE(named.size(), 2U);
  EXPECT_EQ(named[0].id, stranger_);
  EXPECT_EQ(named[1].id, kB);
  EXPECT_EQ(named[0].reason.words, "never seen in training, 1 in this window");
}

TEST_F(EvidenceJudgeOfStrangersTest, SoIsWhoSaysSomethingNewToIt) {
  const EventId news = heard_->intern({"/d", "/own", "T"});
  const EventId of_all = heard_->intern({"/d", "/tf", "T"});
  const auto first = [&](EventId unknown) { return whileFast(unknown).front().id; };
  EXPECT_EQ(first(news), news) << "nobody knows who hears it";
  EXPECT_EQ(first(of_all), kB);
  graph_->connect("/d", "/own", "/c");
  graph_->connect("/d", "/tf", "/b");
  EXPECT_EQ(first(news), kB) << "which does not hear it";
  EXPECT_EQ(first(of_all), kB);
  graph_->connect("/d", "/own", "/b");
  EXPECT_EQ(first(news), news);
  graph_->connect("/d", "/own", "/a");
  limit(kOverdue, kA) = 1;
  EXPECT_EQ(idsOf(whileFast(news, {{0, kA}})), (Ids{kA, kB, news})) << "which did not kill it";
}

TEST_F(EvidenceJudgeOfStrangersTest, WhoDiedIsToBlameBeforeAnyStrangerOfWhileRatesCount) {
  limit(kOverdue, kA) = 1;
  for (const std::int64_t ago : {50 * kMillisecond, kSecond, 3 * kSecond}) {
    start({{kSecond, kA}, {kSecond, kB}});
    Window window{5 * kSecond - kWindow, {}};
    const ObservedEvent observed = *judge_->add({5 * kSecond - ago, stranger_});
    if (ago <= kWindow) {
      window.events.push_back(observed);
    }
    const std::vector<Suspect> named = suspectsIn(window);
    ASSERT_EQ(idsOf(named), ago > kRateSpan ? Ids{kA} : (Ids{kA, stranger_}));
    EXPECT_EQ(named[0].reason.kind, Kind::kSilent);
    EXPECT_TRUE(ago != kSecond ||
                named[1].reason.words == "never seen in training, the last one 1.0 s ago");
  }
}

TEST_F(EvidenceJudgeOfStrangersTest, WhoWasThereLongBeforeIsNotNamedUnlessItComesBack) {
  limit(kOverdue, kA) = 1;
  const Ids strangers{stranger_, heard_->intern({"/extra", "/own", "T"})};
  for (const bool with_pause : {false, true}) {
    start();
    std::vector<Suspect> named;
    for (std::int64_t now = 0; now < 40 * kSecond; now += kWindow) {
      Window window{now, {}};
      for (const EventId id : strangers) {
        if (!with_pause || now < 10 * kSecond || now > 28 * kSecond) {
          window.events.push_back(*judge_->add({now + kMillisecond, id}));
        }
      }
      if (now < 30 * kSecond) {
        judge_->add({now + 2 * kMillisecond, kA});
      }
      judge_->add({now + 3 * kMillisecond, kB});
      named = suspectsIn(window);
    }
    ASSERT_EQ(named.size(), with_pause ? 3U : 1U);
    EXPECT_EQ(named[0].id, kA) << "who died comes first";
    EXPECT_TRUE(!with_pause || named[1].reason.kind == Kind::kStranger);
  }
}

TEST_F(EvidenceJudgeOfStrangersTest, WhatTrainingKnowsByNameIsNotUnknown) {
  const EventId debug = heard_->intern({"/planner", "/debug", "T"});
  const EventId other = heard_->intern({"/planner", "/other", "T"});
  const EventId level = heard_->intern({"/a", "/x", "T[level=8]"});
  graph_->addUnheard({"/planner", "/debug"});
  graph_->addUnheard({"/a", "/x"});  // in one start; in another one it was heard
  start({{0, kA}});
  EXPECT_FALSE(isUnknown(1, debug));
  EXPECT_TRUE(isUnknown(2, other));
  EXPECT_TRUE(isUnknown(3, level));
}

TEST_F(EvidenceJudgeOfStrangersTest, WhoIsAcceptedIsNotUnknownUntilThatIsTakenBack) {
  const EventId other = heard_->intern({"/joystick", "/y", "T"});
  start();
  EXPECT_TRUE(isUnknown(0, stranger_));
  judge_->accept(allOf({accepted("/rostopic", "/y", Kind::kStranger)}));
  EXPECT_FALSE(isUnknown(1, stranger_));
  EXPECT_TRUE(isUnknown(1, other));
  judge_->accept({});
  EXPECT_TRUE(isUnknown(2, stranger_));
}

TEST_F(EvidenceJudgeOfStrangersTest, OfNodesThatLogAnewOnlyErrorsAreNews) {
  start();
  for (const std::string level : {"1", "2", "4"}) {
    EXPECT_FALSE(isNews("/a", "[level=" + level + "]")) << level;
    EXPECT_TRUE(isNews("/new", "[level=" + level + "]")) << "who is it?";
  }
  EXPECT_TRUE(isNews("/a", "[level=8]"));
  EXPECT_TRUE(isNews("/a", "[level=16]"));
  EXPECT_TRUE(isNews("/a", "")) << "by an encoding that tells no levels";
}

TEST_F(EvidenceJudgeOfStrangersTest, AFloodOfLinesOfANewLevelIsNews) {
  start();
  int told = 0;
  std::int64_t stamp = 0;
  const auto log = [&](int lines, std::int64_t gap) {
    for (int line = 0; line < lines; ++line) {
      told += isNews("/a", "[level=4]", stamp += gap) ? 1 : 0;
    }
  };
  log(static_cast<int>(model_->tuning().least_told), kSecond);
  EXPECT_EQ(told, 0);
  log(5, kSecond);
  EXPECT_EQ(told, 5);
  log(50, 3 * kSecond);
  EXPECT_EQ(told, 5) << "with pauses, it is none";
}

TEST_F(EvidenceJudgeOfStrangersTest, WhoWasInTheGraphOfTheTrainingMayLogAnew) {
  graph_->connect("/a", "/x", "/listener");
  graph_->connect("/talker", "/rosout", "/rosout");
  graph_->addUnheard({"/unheard", "/debug"});
  graph_->addLasting({"/lasting", "/gone"});
  start();
  graph_->connect("/late", "/rosout", "/rosout");  // at run time
  for (const std::string source : {"/listener", "/talker", "/unheard", "/lasting"}) {
    EXPECT_FALSE(isNews(source, "[level=2]")) << source;
    EXPECT_TRUE(isNews(source, "[level=8]")) << source;
  }
  EXPECT_TRUE(isNews("/late", "[level=2]")) << "training did not have it";
}

}  // namespace
}  // namespace self_awareness::core::evidence
