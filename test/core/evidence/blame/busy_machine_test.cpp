#include "core/evidence/blame/busy_machine.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "../tracks.h"

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
  std::optional<Busy> at(double share, EventId first, EventId number, bool abnormal = true,
                         const std::string& channel = kFewer) {
    scorer_.closeWindow(now_ += kWindow);
    std::vector<double> shares = allTracks(*model_, 0);
    for (EventId id = first; id < first + number; ++id) {
      ofTrack(shares, *model_, channel, id) = share;
    }
    return machine_.closeWindow(shares, scorer_, events_, abnormal);
  }

  const std::vector<EventType> types_ = numberedTypes(kComponents);
  std::shared_ptr<const Model> model_ =
      std::make_shared<Model>(watch(countsOf({robot(0, 100), robot(2 * kStart, 150)}, types_),
                                    countsOf({robot(kStart, 200)}, types_), {}, withFrozen()));
  Scorer scorer_{model_, kWindow};
  RecentEvents events_{model_->size()};
  BusyMachine machine_{model_};
  std::int64_t now_ = 60 * kSecond;
};

TEST_F(BusyMachineTest, WhoWasLateLongBeforeTheOthersIsSoForAnotherReason) {
  for (int window = 0; window < 300; ++window) {
    EXPECT_FALSE(at(1.2, 1, 1));
  }
  const std::int64_t alone_until = now_;
  const std::optional<Busy> busy = at(1.2, 1, 5);
  ASSERT_TRUE(busy);
  EXPECT_GT(busy->since, alone_until - 20 * kSecond);
  EXPECT_LT(busy->since, alone_until) << "a load that grows makes one after the other late";
  EXPECT_EQ(at(1.2, 1, 5)->since, busy->since);
}

TEST_F(BusyMachineTest, ManyThatAreLateAtOnceHaveABusyMachine) {
  EXPECT_FALSE(at(1.2, 1, 3));
  const std::optional<Busy> busy = at(1.2, 1, 5);
  ASSERT_TRUE(busy);
  EXPECT_EQ(describe(*busy), "the machine may be busy: 5 of 9 components are late");
  EXPECT_EQ(describe(*busy, "load 7.9 on 2 cores"),
            "the machine may be busy (load 7.9 on 2 cores): 5 of 9 components are late");
}

TEST_F(BusyMachineTest, ItIsBusyForAsLongAsManyAreLate) {
  EXPECT_FALSE(at(0.6, 1, 5));
  EXPECT_TRUE(at(1.2, 1, 5));
  EXPECT_TRUE(at(0.6, 1, 5, false));
  EXPECT_TRUE(at(0.6, 3, 4, false));
  EXPECT_FALSE(at(0.4, 1, 5, false));
  EXPECT_FALSE(at(0.6, 1, 5, false));
}

TEST_F(BusyMachineTest, ItIsNotWhileAllAreWithinTheirLimits) {
  EXPECT_FALSE(at(0.9, 1, 7, false));
  EXPECT_TRUE(at(0.9, 1, 7));
  machine_.restart();
  EXPECT_FALSE(at(0.9, 1, 7, false));
}

TEST_F(BusyMachineTest, ItIsStarvedWhileProcessesWait) {
  const auto wait = [&](int windows, double share) {
    std::optional<Busy> busy;
    for (int k = 0; k < windows; ++k) {
      scorer_.hear({now_, now_ + kWindow, static_cast<std::int64_t>(share * kWindow)});
      busy = at(0, 1, 0, false);
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

TEST_F(BusyMachineTest, WhoIsSilentIsNotLate) {
  EXPECT_FALSE(at(1.2, 0, kComponents, true, kOverdue));
}

TEST_F(BusyMachineTest, WhoSaysSomethingElseIsNotLate) {
  for (const char* channel : {kAge, kLost, kSize, kFrozen}) {
    EXPECT_FALSE(at(1.2, 1, 5, true, channel)) << channel;
  }
}

TEST_F(BusyMachineTest, WhoSendsTooOftenIsNotLate) {
  EXPECT_FALSE(at(1.2, 1, kComponents - 1, true, kMore));
  EXPECT_TRUE(at(1.2, 1, 5));
  EXPECT_FALSE(at(1.2, 1, kComponents - 1, true, kMore)) << "nor does it stay busy for that";
}

TEST_F(BusyMachineTest, WhoFollowsAnotherAsUsualIsNoFurtherOne) {
  ASSERT_TRUE(isWatched(model_->tracks(), kPairs, kComponents - 1, 0));
  std::vector<double> shares = allTracks(*model_, 0);
  for (const EventId id : {0U, 1U, 2U, kComponents - 1}) {
    ofTrack(shares, *model_, kFewer, id) = 1.2;
  }
  EXPECT_FALSE(machine_.closeWindow(shares, scorer_, events_, true));
  ofTrack(shares, *model_, kFewer, 3) = 1.2;
  ASSERT_TRUE(machine_.closeWindow(shares, scorer_, events_, true));
}

}  // namespace
}  // namespace self_awareness::core::evidence
