#include "self_awareness/core/evidence/judge.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
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
  static Judgement judgeAt(core::Judge& judge, std::int64_t end,
                           NameSuspects suspects = NameSuspects::kNever) {
    return judge.judge({}, end, suspects);
  }
  // Adds answers as in training, so that all tracks count, and then late ones.
  static void feed(core::Judge& judge, int late) {
    for (int i = 0; i < 40 + late; ++i) {
      const std::int64_t delay = i < 40 ? 20 * kMillisecond : 70 * kMillisecond;
      judge.add({i * kPeriod, kA});
      judge.add({i * kPeriod + delay, kB});
    }
  }

  std::shared_ptr<const Model> model_ =
      std::make_shared<Model>(watchAll(startOf(followed(1), 1, 2), startOf(followed(2), 2, 2)));
  std::shared_ptr<Vocabulary> heard_;  // what is heard; none: what the model knows
  std::shared_ptr<SourceGraph> graph_ = std::make_shared<SourceGraph>();
  Limits limits_ = allLimits(*model_, kNone);
};

TEST_F(EvidenceJudgeTest, TheScoreIsTheLargestShareOfALimit) {
  const std::int64_t age = 700 * kMillisecond;
  const double evidence = toSeconds(age);
  for (const double share : {0.5, 0.99, 1.01}) {
    limit(kOverdue, kA) = evidence / share;
    const std::unique_ptr<core::Judge> judge = newJudge(limits_);
    judge->add({0, kA});
    const Judgement judgement = judgeAt(*judge, age);
    EXPECT_NEAR(judgement.score.value(), -share, 1e-12);
    EXPECT_EQ(judgement.threshold, -1);
    EXPECT_EQ(judgement.abnormal, share > 1);
    EXPECT_EQ(judgement.evidence, share > 1 ? "overdue" : "");
    EXPECT_FALSE(judgement.certain);
    EXPECT_FALSE(judgement.suspicious);
  }
}

TEST_F(EvidenceJudgeTest, SaysWhatIsNotWatchedNow) {
  const auto pairs_of = [](const core::Judge& judge) {
    std::vector<std::pair<EventId, EventId>> pairs;
    for (const Disarmed& each : judge.disarmed()) {
      pairs.emplace_back(each.id, each.after);
    }
    return pairs;
  };
  EXPECT_TRUE(pairs_of(*newJudge(std::nullopt)).empty()) << "nothing is judged";
  EXPECT_TRUE(pairs_of(*newJudge(limits_)).empty()) << "no limit, not judged";
  limit(kPairs, kB, kA) = 14;
  const std::unique_ptr<core::Judge> judge = newJudge(limits_);
  const std::vector<std::pair<EventId, EventId>> b_after_a{{kB, kA}};
  EXPECT_EQ(pairs_of(*judge), b_after_a);
  feed(*judge, 0);
  EXPECT_TRUE(pairs_of(*judge).empty());
}

TEST_F(EvidenceJudgeTest, ASilenceThatHasLastedIsCertain) {
  limit(kOverdue, kA) = 1;
  const std::unique_ptr<core::Judge> judge = newJudge(limits_);
  judge->add({0, kA});
  EXPECT_FALSE(judgeAt(*judge, kSecond).abnormal);
  const Judgement soon = judgeAt(*judge, kSecond + 50 * kMillisecond);
  EXPECT_TRUE(soon.abnormal);
  EXPECT_FALSE(soon.certain);
  EXPECT_TRUE(judgeAt(*judge, kSecond + 101 * kMillisecond).certain);
}

TEST_F(EvidenceJudgeTest, OfAStarvedMachineNobodyIsNamed) {
  limit(kOverdue, kA) = 1.2;
  const std::unique_ptr<core::Judge> judge = newJudge(limits_);
  judge->add({-100 * kSecond, kA});
  judge->add({-100 * kSecond, kB});
  judge->hear({-100 * kSecond, 0, 0});
  judge->add({0, kA});
  Judgement judgement;
  std::int64_t now = 0;
  const auto starve = [&](std::int64_t until) {
    for (; now < until; now += kWindow) {
      judge->hear({now, now + kWindow, kWindow});
      judgement = judgeAt(*judge, now + kWindow, NameSuspects::kIfUnusual);
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
  ASSERT_FALSE(judgement.suspects.empty());
  EXPECT_EQ(judgement.suspects.front().id, kA);
}

TEST_F(EvidenceJudgeTest, AMachineThatStaysStarvedIsAnAlarm) {
  limit(kOverdue, kA) = 1;
  const std::unique_ptr<core::Judge> judge = newJudge(limits_);
  judge->add({-100 * kSecond, kB});
  judge->hear({-100 * kSecond, 0, 0});
  for (std::int64_t now = 0; now < 62 * kSecond; now += kWindow) {
    judge->add({now, kA});
    judge->add({now, kB});
    judge->hear({now, now + kWindow, kWindow});
    const Judgement judgement = judgeAt(*judge, now + kWindow, NameSuspects::kIfUnusual);
    EXPECT_EQ(judgement.suspicious, now >= 1700 * kMillisecond) << toSeconds(now);
    if (now != 60 * kSecond - kWindow) {  // a minute, to the last digit
      EXPECT_EQ(judgement.abnormal, now >= 60 * kSecond) << toSeconds(now);
    }
    EXPECT_TRUE(judgement.suspects.empty());
  }
}

TEST_F(EvidenceJudgeTest, AllAreSilentIfEverybodyShouldHaveSpoken) {
  limit(kOverdue, kA) = 1;
  limit(kOverdue, kB) = 11;
  const std::unique_ptr<core::Judge> judge = newJudge(limits_);
  judge->add({0, kA});
  const std::int64_t end = kSecond + 50 * kMillisecond;
  EXPECT_FALSE(judgeAt(*judge, end).silent.has_value()) << "of the other nothing is known yet";
  judge->add({end, kB});
  EXPECT_TRUE(judgeAt(*judge, end + kWindow).abnormal);
  EXPECT_FALSE(judgeAt(*judge, end + kWindow).silent.has_value()) << "the other one speaks";
  EXPECT_TRUE(judgeAt(*judge, end + 10 * kSecond).silent.has_value())
      << "though not yet at its limit";
}

TEST_F(EvidenceJudgeTest, WhoSaysAnotherThingIsNotSilent) {
  // /a says two things in turn, and /b one.
  const auto start = [](std::int64_t from) {
    return countsOf({together({timer(0, from, from + 100 * kSecond, kSecond),
                               timer(1, from + kSecond / 2, from + 100 * kSecond, kSecond),
                               timer(2, from, from + 100 * kSecond, kPeriod)})},
                    {{"/a", "/x", "T"}, {"/a", "/w", "T"}, {"/b", "/y", "T"}});
  };
  model_ = std::make_shared<Model>(watch(start(0), start(kStart)));
  limits_ = allLimits(*model_, kNone);
  for (EventId id = 0; id < 3; ++id) {
    limit(kOverdue, id) = 2;
  }
  const std::unique_ptr<core::Judge> judge = newJudge(limits_);
  for (const Event& event : std::vector<Event>{{0, 2}, {kSecond, 0}, {2500 * kMillisecond, 1}}) {
    judge->add(event);
  }
  const std::int64_t now = 2800 * kMillisecond;  // /x should have come 0.8 s ago
  EXPECT_TRUE(judgeAt(*judge, now).abnormal);
  EXPECT_FALSE(judgeAt(*judge, now).silent.has_value());
  judge->add({2900 * kMillisecond, 2});
  EXPECT_TRUE(judgeAt(*judge, 6 * kSecond).silent.has_value());
}

TEST_F(EvidenceJudgeTest, LateAnswersAreAbnormalButNotCertain) {
  limit(kPairs, kB, kA) = model_->leastLimit(indexOf(model_->tracks(), kPairs, kB, kA));
  const std::unique_ptr<core::Judge> usual = newJudge(limits_);
  feed(*usual, 0);
  EXPECT_EQ(judgeAt(*usual, 40 * kPeriod).score, 0);
  const std::unique_ptr<core::Judge> judge = newJudge(limits_);
  feed(*judge, 5);
  const Judgement judgement = judgeAt(*judge, 45 * kPeriod, NameSuspects::kIfUnusual);
  EXPECT_TRUE(judgement.abnormal);
  EXPECT_FALSE(judgement.certain);
  EXPECT_EQ(judgement.evidence, "pairs");
  ASSERT_FALSE(judgement.suspects.empty());
  EXPECT_EQ(judgement.suspects.front().id, kB);
}

TEST_F(EvidenceJudgeTest, NamesSuspectsOnlyWhereTheyAreAskedFor) {
  limit(kOverdue, kA) = 1;
  const std::unique_ptr<core::Judge> judge = newJudge(limits_);
  judge->add({0, kA});
  const Window unknown{0, {{{0, kC}, true, {}}}};
  EXPECT_TRUE(judge->judge(unknown, kPeriod, NameSuspects::kIfUnusual).suspects.empty());
  EXPECT_EQ(judge->judge(unknown, kPeriod, NameSuspects::kAlways).suspects.size(), 1U);
  EXPECT_TRUE(judge->judge({}, 2 * kSecond, NameSuspects::kNever).suspects.empty());
  EXPECT_EQ(judge->judge({}, 2 * kSecond, NameSuspects::kIfUnusual).suspects.size(), 1U);
  EXPECT_TRUE(newJudge(std::nullopt)->judge(unknown, 0, NameSuspects::kAlways).suspects.empty());
  // A is near its limit, but within its own range.
  const std::unique_ptr<core::Judge> near = newJudge(limits_);
  near->add({0, kA});
  const Judgement beside = near->judge(unknown, 960 * kMillisecond, NameSuspects::kAlways);
  EXPECT_GT(-*beside.score, model_->tuning().near_limit);
  EXPECT_FALSE(beside.abnormal);
  EXPECT_EQ(idsOf(beside.suspects), std::vector<EventId>{kC});
}

TEST_F(EvidenceJudgeTest, WithoutLimitsItSaysNothingAndThoseOfAnotherModelAreRefused) {
  const std::unique_ptr<core::Judge> judge = newJudge(std::nullopt);
  judge->add({0, kA});
  const Judgement judgement = judgeAt(*judge, 3000 * kSecond);
  EXPECT_FALSE(judgement.score.has_value());
  EXPECT_FALSE(judgement.threshold.has_value());
  EXPECT_FALSE(judgement.abnormal || judgement.certain || judgement.suspicious);
  limits_.tracks.pop_back();
  EXPECT_THROW(newJudge(limits_), std::invalid_argument) << "those of another model";
}

TEST_F(EvidenceJudgeTest, WhatIsAcceptedIsNoEvidenceAndAllElseIs) {
  limit(kOverdue, kA) = 1;
  limit(kOverdue, kB) = 1;
  limit(kSlower, kB) = 2;
  const auto judgedWith = [&](const Acceptances& all) {
    const std::unique_ptr<core::Judge> judge = newJudge(limits_);
    for (int i = 0; i < 40; ++i) {
      judge->add({i * kPeriod, kA});
      judge->add({i * kPeriod + 20 * kMillisecond, kB});
      judgeAt(*judge, i * kPeriod + kWindow);
    }
    judge->accept(all);
    return judgeAt(*judge, 40 * kPeriod + 3 * kSecond, NameSuspects::kIfUnusual);
  };
  const auto named = [](const Judgement& judgement) {
    const std::vector<EventId> ids = idsOf(judgement.suspects);
    return std::set<EventId>(ids.begin(), ids.end());
  };
  EXPECT_TRUE(judgedWith({}).silent) << "all are";
  const Judgement still_silent = judgedWith(allOf({accepted("/b", "", Kind::kSlow)}));
  EXPECT_EQ(still_silent.evidence, "overdue") << "its rate is accepted, its silence is not";
  EXPECT_TRUE(still_silent.silent);
  const Judgement of_a = judgedWith(allOf({accepted("/b")}));
  EXPECT_TRUE(of_a.abnormal) << "another one is silent, too";
  EXPECT_EQ(named(of_a), (std::set<EventId>{kA}));
  const Judgement normal =
      judgedWith(allOf({accepted("/b"), accepted("/a*", "/x", Kind::kSilent)}));
  EXPECT_EQ(normal.score.value(), 0);
  EXPECT_FALSE(normal.abnormal);
}

TEST_F(EvidenceJudgeTest, WhoIsOptionalMayBeAbsentAndIsJudgedWhileThere) {
  limit(kOverdue, kB) = 1;
  limit(kSlower, kB) = 4;
  const std::unique_ptr<core::Judge> judge = newJudge(limits_);
  Acceptances optional;
  optional.add(accepted("/b", "", Kind::kNeverCame));
  judge->accept(optional);
  const auto play = [&](int from, int to, int every) {  // B answers every so many times
    double worst = 0;
    for (int i = from; i < to; ++i) {
      judge->add({i * kPeriod, kA});
      if (every > 0 && i % every == 0) {
        judge->add({i * kPeriod + 20 * kMillisecond, kB});
      }
      for (int window = 1; window <= 2; ++window) {
        const std::int64_t end = i * kPeriod + window * kWindow;
        worst = std::min(
            worst, judge->judge({end - kWindow, {}}, end, NameSuspects::kNever).score.value());
      }
    }
    return worst;
  };
  judge->settle({0, kB}, kSecond);
  EXPECT_GT(play(0, 40, 1), -1) << "it is there";
  const std::int64_t gone = model_->longestGap(kB) / kPeriod;
  EXPECT_GT(play(40, 120, 0), -1) << "absent, for longer than " << gone << " periods";
  EXPECT_GT(play(120, 160, 1), -1) << "back";
  EXPECT_LT(play(160, 200, 5), -1) << "there, and slow";
}

TEST_F(EvidenceJudgeTest, WhatSettlesIsNotJudgedAndAllElseIs) {
  limit(kOverdue, kA) = 1;
  limit(kPairs, kB, kA) = 1;
  const std::int64_t now = 45 * kPeriod;
  const auto evidenceAt = [&](std::int64_t start, EventId is_new, std::int64_t until) {
    const std::unique_ptr<core::Judge> judge = newJudge(limits_);
    judge->settle({until - kSecond, is_new}, kSecond);
    feed(*judge, 5);
    Judgement judgement = judge->judge({start, {}}, now + 3 * kSecond, NameSuspects::kNever);
    EXPECT_FALSE(judgement.settling);
    return judgement.evidence;
  };
  EXPECT_EQ(evidenceAt(now, kB, now + 1), "overdue");  // its pair with A is left out
  EXPECT_EQ(evidenceAt(now, kB, now), "overdue");      // and what it has said so far
  EXPECT_EQ(evidenceAt(now, kA, now + 1), "");
  EXPECT_EQ(evidenceAt(now, kC, now + 1), "overdue, pairs");  // unknown to the model
}

TEST_F(EvidenceJudgeTest, WhatWasUnusualOfAStartDoesNotCountAfterwards) {
  limit(kPairs, kB, kA) = 13;
  const std::unique_ptr<core::Judge> judge = newJudge(limits_);
  feed(*judge, 5);
  std::int64_t now = 45 * kPeriod;
  judge->settle({0, kB}, now);
  EXPECT_FALSE(judge->judge({now - 1, {}}, now, NameSuspects::kNever).abnormal);
  EXPECT_FALSE(judge->judge({now, {}}, now + kWindow, NameSuspects::kNever).abnormal);
  for (int i = 45; i < 50; ++i) {
    judge->add({i * kPeriod, kA});
    judge->add({i * kPeriod + 70 * kMillisecond, kB});
  }
  now = 50 * kPeriod;
  EXPECT_TRUE(judge->judge({now, {}}, now + kWindow, NameSuspects::kNever).abnormal);
}

TEST_F(EvidenceJudgeTest, WhatWasMissedIsNotJudgedAndAllElseIs) {
  limit(kOverdue, kA) = 1;
  limit(kPairs, kB, kA) = 1;
  const std::unique_ptr<core::Judge> judge = newJudge(limits_);
  feed(*judge, 5);
  const std::int64_t now = 45 * kPeriod;
  judge->leaveOut({kB}, now + 1);
  EXPECT_EQ(judge->judge({now, {}}, now + 3 * kSecond, NameSuspects::kNever).evidence, "overdue");
  judge->leaveOut({kA, kC}, now + 2 * kSecond);
  EXPECT_FALSE(
      judge->judge({now + kSecond, {}}, now + 3 * kSecond, NameSuspects::kNever).abnormal);
  judge->leaveOut({kA}, now + kSecond);  // it was left out for longer before
  EXPECT_FALSE(
      judge->judge({now + kSecond, {}}, now + 3 * kSecond, NameSuspects::kNever).abnormal);
  EXPECT_TRUE(
      judge->judge({now + 2 * kSecond, {}}, now + 3 * kSecond, NameSuspects::kNever).abnormal);
}

TEST_F(EvidenceJudgeTest, WhoWasSilentBeforeThisProgramStoodStillIsSilentStill) {
  limit(kOverdue, kA) = 1;
  limit(kPairs, kB, kA) = 1;
  const std::unique_ptr<core::Judge> judge = newJudge(limits_);
  feed(*judge, 5);
  const std::int64_t last = 44 * kPeriod;  // of A, which dies
  const std::int64_t resumed = last + 10 * kSecond;
  const std::int64_t settled = resumed + 3 * kSecond;
  const auto judgeTo = [&](std::int64_t end) {
    return judge->judge({end - kWindow, {}}, end, NameSuspects::kIfUnusual);
  };
  EXPECT_EQ(judgeTo(last + kWindow).evidence, "pairs");
  judge->standStill({last + kWindow, resumed, resumed - last - kWindow}, settled);
  judge->add({last + 80 * kMillisecond, kB});  // waited in a queue
  EXPECT_FALSE(judgeTo(last + 5 * kSecond).abnormal) << "a window in which nobody listened";
  judge->add({resumed, kB});
  EXPECT_FALSE(judgeTo(resumed + 800 * kMillisecond).abnormal) << "what else was unusual settles";
  EXPECT_FALSE(judgeTo(resumed + kSecond).abnormal) << "loops may have another phase";
  const Judgement found = judgeTo(resumed + 1100 * kMillisecond);
  EXPECT_TRUE(found.abnormal);
  EXPECT_EQ(found.evidence, "overdue");
  ASSERT_FALSE(found.suspects.empty());
  EXPECT_EQ(found.suspects.front().id, kA);
  EXPECT_GT(found.suspects.front().reason.value, 10) << "for so long it was not heard";
}

TEST_F(EvidenceJudgeTest, AfterARestartAllBeginsAnew) {
  limit(kOverdue, kA) = 1;
  const std::unique_ptr<core::Judge> judge = newJudge(limits_);
  judge->settle({0, kA}, 1000 * kSecond);
  judge->add({0, kA});
  EXPECT_FALSE(judgeAt(*judge, 100 * kSecond).abnormal);
  judge->restart();
  EXPECT_FALSE(judgeAt(*judge, 200 * kSecond).abnormal) << "nor is known what was heard";
  judge->add({0, kA});
  EXPECT_TRUE(judgeAt(*judge, 100 * kSecond).abnormal);
}

TEST_F(EvidenceJudgeTest, WhoDoesNotSubscribeIsASuspicionAndHidesNobody) {
  limit(kOverdue, kA) = 100;
  const std::unique_ptr<core::Judge> judge = newJudge(limits_);
  judge->add({0, kA});
  judge->add({0, kB});
  judge->setMissing({{"/b", "/x"}});
  EXPECT_FALSE(judgeAt(*judge, kSecond).suspicious);
  const Judgement missing = judgeAt(*judge, 62 * kSecond, NameSuspects::kIfUnusual);
  EXPECT_TRUE(missing.suspicious);
  EXPECT_FALSE(missing.abnormal);
  EXPECT_EQ(missing.evidence, "connections");
  ASSERT_EQ(missing.suspects.size(), 1U);
  EXPECT_EQ(missing.suspects[0].id, kB) << "kA is near its limit, and no more";
  judge->accept(allOf({accepted("/b", "/x", Kind::kUnsubscribed)}));
  EXPECT_FALSE(judgeAt(*judge, 63 * kSecond).suspicious);
  judge->accept({});
  const Judgement death = judgeAt(*judge, 101 * kSecond, NameSuspects::kIfUnusual);
  EXPECT_TRUE(death.abnormal);
  ASSERT_EQ(death.suspects.size(), 2U);
  EXPECT_EQ(death.suspects[0].id, kA);
  EXPECT_EQ(death.suspects[1].reason.kind, Kind::kUnsubscribed);
  judge->setMissing({});
  EXPECT_FALSE(judgeAt(*judge, 102 * kSecond).suspicious);
}

class EvidenceJudgeOfStrangersTest : public EvidenceJudgeTest {
 protected:
  EvidenceJudgeOfStrangersTest() { heard_ = std::make_shared<Vocabulary>(model_->vocabulary()); }
  // Whether it is news that a node logs, at a level.
  bool isNews(core::Judge& judge, const std::string& source, const std::string& level,
              std::int64_t stamp = kSecond) {
    return judge.add({stamp, heard_->intern({source, "/rosout", "rosgraph_msgs/Log" + level})})
        ->unknown;
  }
  // A is silent, and is suspected; before, an unknown sender was heard.
  std::vector<Suspect> suspectsAfter(const EventType& unknown, std::int64_t ago) {
    const EventId id = heard_->intern(unknown);
    limit(kOverdue, kA) = 1;
    const std::unique_ptr<core::Judge> judge = newJudge(limits_);
    const std::int64_t end = 5 * kSecond;
    judge->add({kSecond, kA});
    judge->add({kSecond, kB});
    const Event event{end - ago, id};
    Window window;
    window.start = end - kWindow;
    const ObservedEvent observed = judge->add(event).value();
    if (ago <= kWindow) {
      window.events.push_back(observed);
    }
    return judge->judge(window, end, NameSuspects::kIfUnusual).suspects;
  }
};

TEST_F(EvidenceJudgeOfStrangersTest, AnUnknownSenderOnAKnownTopicIsTheFirstSuspectOfARate) {
  const EventId stranger = heard_->intern({"/rostopic", "/y", "T"});
  limit(kFaster, kB) = 3;
  const std::unique_ptr<core::Judge> judge = newJudge(limits_);
  std::vector<Suspect> named;
  for (std::int64_t now = 0; now < 5 * kSecond; now += kWindow) {
    Window window{now, {}};
    for (int i = 0; i < 5; ++i) {
      window.events.push_back(*judge->add({now + i * kMillisecond, kB}));
    }
    window.events.push_back(*judge->add({now + kWindow / 2, stranger}));
    named = judge->judge(window, now + kWindow, NameSuspects::kIfUnusual).suspects;
  }
  ASSERT_GE(named.size(), 2U);
  EXPECT_EQ(heard_->at(named[0].id).source, "/rostopic");
  EXPECT_EQ(named[0].reason.words, "never seen in training, 1 in this window");
  EXPECT_EQ(named[1].id, kB);
}

TEST_F(EvidenceJudgeOfStrangersTest, WhoDiedIsToBlameBeforeAnyStrangerOfWhileRatesCount) {
  const EventType stranger{"/rostopic", "/y", "T"};
  for (const std::int64_t ago : {50 * kMillisecond, kSecond}) {
    const std::vector<Suspect> named = suspectsAfter(stranger, ago);
    ASSERT_EQ(named.size(), 2U);
    EXPECT_EQ(named[0].id, kA);
    EXPECT_EQ(named[0].reason.kind, Kind::kSilent);
    EXPECT_EQ(heard_->at(named[1].id).source, "/rostopic");
    EXPECT_TRUE(ago < kSecond ||
                named[1].reason.words == "never seen in training, the last one 1.0 s ago");
  }
  EXPECT_EQ(suspectsAfter(stranger, 3 * kSecond).size(), 1U);
}

TEST_F(EvidenceJudgeOfStrangersTest, WhoWasThereLongBeforeIsNotNamedUnlessItComesBack) {
  limit(kOverdue, kA) = 1;
  const std::vector<EventId> strangers{heard_->intern({"/rostopic", "/y", "T"}),
                                       heard_->intern({"/extra", "/own", "T"})};
  const auto named = [&](bool with_pause) {
    const std::unique_ptr<core::Judge> judge = newJudge(limits_);
    std::vector<Suspect> suspects;
    for (std::int64_t now = 0; now < 40 * kSecond; now += kWindow) {
      Window window{now, {}};
      for (const EventId id : strangers) {
        if (!with_pause || now < 10 * kSecond || now > 28 * kSecond) {
          window.events.push_back(*judge->add({now + kMillisecond, id}));
        }
      }
      if (now < 30 * kSecond) {
        judge->add({now + 2 * kMillisecond, kA});
      }
      judge->add({now + 3 * kMillisecond, kB});
      suspects = judge->judge(window, now + kWindow, NameSuspects::kIfUnusual).suspects;
    }
    return suspects;
  };
  const std::vector<Suspect> without = named(false);
  ASSERT_FALSE(without.empty());
  EXPECT_EQ(without[0].id, kA);
  for (const Suspect& suspect : without) {
    EXPECT_NE(suspect.reason.kind, Kind::kStranger) << suspect.reason.words;
  }
  const std::vector<Suspect> with = named(true);
  ASSERT_EQ(with.size(), without.size() + strangers.size());
  EXPECT_EQ(with[0].id, kA) << "who died comes first";
  EXPECT_EQ(with[1].reason.kind, Kind::kStranger);
}

TEST_F(EvidenceJudgeOfStrangersTest, ManyStrangersDoNotHideWhoIsToBlame) {
  limit(kOverdue, kA) = 1;
  const std::unique_ptr<core::Judge> judge = newJudge(limits_);
  judge->add({kSecond, kA});
  judge->add({kSecond, kB});
  Window window;
  window.start = 5 * kSecond - kWindow;
  for (int number = 0; number < 6; ++number) {
    const EventId id = heard_->intern({"/stranger" + std::to_string(number), "/y", "T"});
    window.events.push_back(*judge->add({5 * kSecond - 50 * kMillisecond, id}));
  }
  const std::vector<Suspect> named =
      judge->judge(window, 5 * kSecond, NameSuspects::kIfUnusual).suspects;
  ASSERT_EQ(named.size(), 7U);
  EXPECT_EQ(named[0].id, kA);
  EXPECT_EQ(named[1].reason.kind, Kind::kStranger);
  EXPECT_EQ(named[6].reason.kind, Kind::kStranger);
}

TEST_F(EvidenceJudgeOfStrangersTest, WhatTrainingKnowsByNameIsNotUnknown) {
  const EventId debug = heard_->intern({"/planner", "/debug", "T"});
  const EventId other = heard_->intern({"/planner", "/other", "T"});
  const EventId level = heard_->intern({"/a", "/x", "T[level=8]"});
  graph_->addUnheard({"/planner", "/debug"});
  graph_->addUnheard({"/a", "/x"});  // in one start; in another one it was heard
  limit(kOverdue, kA) = 1;
  const std::unique_ptr<core::Judge> judge = newJudge(limits_);
  judge->add({0, kA});
  EXPECT_FALSE(judge->add({1, debug})->unknown);
  EXPECT_TRUE(judge->add({2, other})->unknown);
  EXPECT_TRUE(judge->add({3, level})->unknown);
}

TEST_F(EvidenceJudgeOfStrangersTest, WhoIsAcceptedIsNotUnknownUntilThatIsTakenBack) {
  const EventId id = heard_->intern({"/rostopic", "/y", "T"});
  const EventId other = heard_->intern({"/joystick", "/y", "T"});
  const std::unique_ptr<core::Judge> judge = newJudge(limits_);
  EXPECT_TRUE(judge->add({0, id})->unknown);
  judge->accept(allOf({accepted("/rostopic", "/y", Kind::kStranger)}));
  EXPECT_FALSE(judge->add({1, id})->unknown);
  EXPECT_TRUE(judge->add({1, other})->unknown);
  judge->accept({});
  EXPECT_TRUE(judge->add({2, id})->unknown);
}

TEST_F(EvidenceJudgeOfStrangersTest, OfNodesThatLogAnewOnlyErrorsAreNews) {
  const std::unique_ptr<core::Judge> judge = newJudge(limits_);
  for (const std::string level : {"1", "2", "4"}) {
    EXPECT_FALSE(isNews(*judge, "/a", "[level=" + level + "]")) << level;
    EXPECT_TRUE(isNews(*judge, "/new", "[level=" + level + "]")) << "who is it?";
  }
  EXPECT_TRUE(isNews(*judge, "/a", "[level=8]"));
  EXPECT_TRUE(isNews(*judge, "/a", "[level=16]"));
  EXPECT_TRUE(isNews(*judge, "/a", "")) << "by an encoding that tells no levels";
}

TEST_F(EvidenceJudgeOfStrangersTest, AFloodOfLinesOfANewLevelIsNews) {
  const std::unique_ptr<core::Judge> judge = newJudge(limits_);
  int told = 0;
  std::int64_t stamp = 0;
  const auto log = [&](int lines, std::int64_t gap) {
    for (int line = 0; line < lines; ++line) {
      stamp += gap;
      told += isNews(*judge, "/a", "[level=4]", stamp) ? 1 : 0;
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
  const std::unique_ptr<core::Judge> judge = newJudge(limits_);
  graph_->connect("/late", "/rosout", "/rosout");  // at run time
  for (const std::string source : {"/listener", "/talker", "/unheard", "/lasting"}) {
    EXPECT_FALSE(isNews(*judge, source, "[level=2]")) << source;
    EXPECT_TRUE(isNews(*judge, source, "[level=8]")) << source;
  }
  EXPECT_TRUE(isNews(*judge, "/late", "[level=2]")) << "training did not have it";
}

}  // namespace
}  // namespace self_awareness::core::evidence
