#include "core/evidence/excuse/busy_machine.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "../tracks.h"
#include "core/evidence/excuse/excuses.h"

namespace self_awareness::core::evidence {
namespace {

constexpr EventId kComponents = 9;

// All at random but the last one, which answers the first one.
Events robot(std::int64_t start, unsigned seed) {
  const Attributes usual{ageClass(kMillisecond), sizeClass(100), Attributes::Step::kNext, false};
  Events events = atRandom(kComponents - 1, start, 60 * kSecond, 200 * kMillisecond, seed);
  const Events asked = without(events, [](const Event& event) { return event.id > 0; });
  events = together({events, answers(kComponents - 1, asked, 20 * kMillisecond)});
  for (Event& event : events) {
    event.attributes = usual;
  }
  return events;
}

class BusyMachineTest : public testing::Test {
 protected:
  BusyMachineTest() {
    addAll(scorer_, robot(0, 300));
    scorer_.closeWindow(60 * kSecond);
  }
  /// Contents that changed for a minute change always.
  static Tuning withFrozen() {
    Tuning tuning;
    tuning.changing_time = 60;
    return tuning;
  }
  // The components from `first` on have these shares of their limits.
  std::vector<double> sharesOf(double share, EventId first, EventId number,
                               const std::string& channel = kSlower) const {
    std::vector<double> shares = allTracks(*model_, 0);
    for (EventId id = first; id < first + number; ++id) {
      ofTrack(shares, *model_, channel, id) = share;
    }
    return shares;
  }
  std::optional<Busy> at(double share, EventId first, EventId number,
                         const std::string& channel = kSlower) {
    scorer_.closeWindow(now_ += kWindow);
    return excuse(sharesOf(share, first, number, channel));
  }
  std::optional<Busy> excuse(const std::vector<double>& shares) {
    excesses_ = excessesOf(model_, shares, scorer_);
    return excuse();
  }
  std::optional<Busy> excuse() {
    Judgement judgement;
    machine_.closeWindow(excesses_, moment_.in(excesses_, scorer_, events_), judgement);
    return judgement.busy;
  }
  static Excuses::List listOf(const std::shared_ptr<const Model>& model) {
    Excuses::List list;
    list.push_back(std::make_unique<BusyMachine>(model));
    return list;
  }

  const std::vector<EventType> types_ = numberedTypes(kComponents);
  std::shared_ptr<const Model> model_ =
      std::make_shared<Model>(watchAll(countsOf({robot(0, 100), robot(2 * kStart, 150)}, types_),
                                       countsOf({robot(kStart, 200)}, types_), withFrozen()));
  std::shared_ptr<SourceGraph> graph_ = std::make_shared<SourceGraph>();
  Scorer scorer_{model_, kWindow};
  RecentEvents events_{model_->size()};
  Moment moment_{model_, graph_};
  Excuses machine_{model_, listOf(model_)};
  std::vector<Excess> excesses_;
  std::int64_t now_ = 60 * kSecond;
};

TEST_F(BusyMachineTest, WhoWasLateLongBeforeTheOthersIsSoForAnotherReason) {
  for (int window = 0; window < 300; ++window) {
    EXPECT_FALSE(at(1.2, 1, 1));
  }
  const std::int64_t alone_until = now_;
  at(1.2, 1, 0);
  excesses_ = excessesOf(model_, sharesOf(1.2, 1, 5), scorer_);
  for (Excess& excess : excesses_) {
    excess.onset = excess.component == 1 ? alone_until - 30 * kSecond : now_ - kSecond;
  }
  const std::optional<Busy> busy = excuse();
  ASSERT_TRUE(busy);
  EXPECT_GT(busy->since, alone_until - 20 * kSecond);
  EXPECT_LT(busy->since, alone_until) << "a load that grows makes one after the other late";
}

TEST_F(BusyMachineTest, ManyThatAreLateAtOnceHaveABusyMachineUnlessAllAreWithinTheirLimits) {
  EXPECT_FALSE(at(1.2, 1, 3));
  const std::optional<Busy> busy = at(1.2, 1, 5);
  ASSERT_TRUE(busy);
  EXPECT_EQ(describe(*busy), "the machine may be busy: 5 of 9 components are late");
  EXPECT_EQ(describe(*busy, "load 7.9 on 2 cores"),
            "the machine may be busy (load 7.9 on 2 cores): 5 of 9 components are late");
  machine_.restart();
  EXPECT_FALSE(at(0.9, 1, 7));
  EXPECT_TRUE(at(1.1, 1, 7));
  machine_.restart();
  EXPECT_FALSE(at(0.9, 1, 7));
}

TEST_F(BusyMachineTest, ItIsBusyForAsLongAsManyAreLateNowAndThen) {
  EXPECT_TRUE(at(1.2, 1, 5));
  for (int second = 0; second < 30; ++second) {
    now_ += kSecond - kWindow;
    EXPECT_TRUE(at(0.8, 1 + second % 5, 1)) << "another one every second";
  }
  now_ += 11 * kSecond;
  EXPECT_FALSE(at(0.8, 1, 1));
}

TEST_F(BusyMachineTest, WhatBeganBeforeIsNotExcused) {
  ASSERT_TRUE(at(1.2, 1, 5));
  const auto excuseOf = [&](std::int64_t onset, EventId id, const char* channel) {
    excesses_ = excessesOf(model_, sharesOf(1.5, id, 1, channel), scorer_);
    excesses_.front().onset = onset;
    excuse();
    return excesses_.front().excused;
  };
  EXPECT_EQ(excuseOf(now_, 1, kSlower), Excused::kBusy);
  EXPECT_EQ(excuseOf(now_ - 20 * kSecond, 1, kSlower), Excused::kNo);
  EXPECT_EQ(excuseOf(now_, 1, kAge), Excused::kNo) << "what they hold is another thing";
  EXPECT_EQ(excuseOf(now_, 1, kFaster), Excused::kNo) << "a flood takes the time, it needs none";
}

TEST_F(BusyMachineTest, ItIsStarvedWhileProcessesWait) {
  const auto wait = [&](int windows, double share) {
    std::optional<Busy> busy;
    for (int k = 0; k < windows; ++k) {
      scorer_.hear({now_, now_ + kWindow, static_cast<std::int64_t>(share * kWindow)});
      busy = at(0, 1, 0);
    }
    return busy;
  };
  EXPECT_FALSE(wait(100, 0.05));
  EXPECT_FALSE(wait(17, 1)) << "for less than nine tenths of the last two seconds";
  EXPECT_TRUE(wait(1, 1));
  const std::optional<Busy> busy = wait(12, 1);
  ASSERT_TRUE(busy);
  EXPECT_NEAR(busy->starved, 3, 1e-9);
  EXPECT_EQ(describe(*busy), "the machine has been starved for 3.0 s");
  EXPECT_EQ(describe({3, 9, 1.2}, "load 7.9 on 2 cores"),
            "the machine has been starved for 1.2 s (load 7.9 on 2 cores): 3 of 9 components are "
            "late");
  EXPECT_TRUE(wait(2, 0));
  EXPECT_FALSE(wait(1, 0));
}

TEST_F(BusyMachineTest, WhoIsSilentOrSaysSomethingElseOrSendsTooOftenIsNotLate) {
  for (const char* channel : {kOverdue, kAge, kLost, kSize, kFrozen, kFaster}) {
    EXPECT_FALSE(at(1.2, 1, kComponents - 1, channel)) << channel;
  }
  EXPECT_TRUE(at(1.2, 1, 5));
}

TEST_F(BusyMachineTest, WhoFollowsAnotherAsUsualIsNoFurtherOne) {
  ASSERT_TRUE(isWatched(model_->tracks(), kPairs, kComponents - 1, 0));
  std::vector<double> shares = sharesOf(1.2, 0, 3);
  ofTrack(shares, *model_, kSlower, kComponents - 1) = 1.2;
  EXPECT_FALSE(excuse(shares));
  ofTrack(shares, *model_, kSlower, 3) = 1.2;
  ASSERT_TRUE(excuse(shares));
}

}  // namespace
}  // namespace self_awareness::core::evidence
