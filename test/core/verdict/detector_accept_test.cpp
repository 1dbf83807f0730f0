// What is accepted while something stands, or is known to be new.

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "self_awareness/core/verdict/detector.h"

namespace self_awareness::core {
namespace {

constexpr std::int64_t kWindow = 100000000;
constexpr std::int64_t kSecond = 10 * kWindow;
constexpr EventId kKnown = 0;
constexpr EventId kNew = 1;
const std::vector<EventType> kTypes{{"/base", "/odom", "T"}, {"/joystick", "/joy", "T"}};

// Nothing is abnormal.
class QuietJudge : public Judge {
 public:
  std::optional<ObservedEvent> add(const Event& event) override {
    return ObservedEvent{event, event.id == kNew && !isAccepted(event.id, Kind::kStranger),
                         std::nullopt};
  }
  void settle(const Event& /*first*/, std::int64_t /*settle_time*/) override {}
  void leaveOut(const std::vector<EventId>& /*ids*/, std::int64_t /*until*/) override {}
  void standStill(const Waiting& /*pause*/, std::int64_t /*until*/) override {}
  void accept(const Acceptances& accepted) override { accepted_ = accepted; }
  bool isAccepted(EventId id, Kind kind) const override {
    return accepted_.covers(kTypes[id].source, kTypes[id].scope, kind);
  }
  Judgement judge(const Window& /*window*/, std::int64_t /*end*/,
                  NameSuspects /*suspects*/) override {
    Judgement judgement;
    judgement.score = 0;
    judgement.threshold = -1;
    return judgement;
  }
  void restart() override {}

 private:
  Acceptances accepted_;
};

class DetectorAcceptTest : public testing::Test {
 protected:
  void make(UnknownEvents unknown = UnknownEvents::kWarn) {
    Detector::Parameters parameters;
    parameters.unknown = unknown;
    parameters.settle_time = kSecond;
    detector_ = std::make_unique<Detector>(std::make_unique<QuietJudge>(), kWindow, parameters,
                                           [this](const Verdict& verdict) { verdict_ = verdict; });
  }
  // Passes windows with a known event each.
  void windows(int number) {
    for (int i = 0; i < number; ++i) {
      detector_->add({now_, kKnown});
      detector_->advance(now_ += kWindow);
    }
  }
  void add(EventId id) { detector_->add({now_, id}); }
  static Acceptances of(EventId id, Kind kind) {
    Acceptance one;
    one.component = kTypes[id].source;
    one.topic = kTypes[id].scope;
    one.kind = kind;
    Acceptances all;
    all.add(one);
    return all;
  }

  std::unique_ptr<Detector> detector_;
  std::int64_t now_ = 0;
  Verdict verdict_;
};

TEST_F(DetectorAcceptTest, WhoIsAcceptedIsNotNewAndToldOnceMoreAfterThatIsTakenBack) {
  make();
  windows(20);
  add(kNew);
  windows(1);
  EXPECT_TRUE(verdict_.suspicion);
  windows(30);
  EXPECT_FALSE(verdict_.suspicion) << "it was told once";
  EXPECT_EQ(detector_->unknown().size(), 1U);
  detector_->accept(of(kNew, Kind::kStranger));
  EXPECT_TRUE(detector_->unknown().empty());
  add(kNew);
  windows(1);
  EXPECT_FALSE(verdict_.suspicion);
  EXPECT_TRUE(detector_->unknown().empty());
  detector_->accept({});
  add(kNew);
  windows(1);
  EXPECT_TRUE(verdict_.suspicion) << "told again";
  windows(30);
  add(kNew);
  windows(1);
  EXPECT_FALSE(verdict_.suspicion) << "once";
}

TEST_F(DetectorAcceptTest, WhatIsAcceptedWhileItsWindowIsOpenIsNoNews) {
  for (const UnknownEvents unknown : {UnknownEvents::kWarn, UnknownEvents::kError}) {
    make(unknown);
    windows(20);
    add(kNew);
    detector_->accept(of(kNew, Kind::kStranger));
    windows(1);
    EXPECT_FALSE(verdict_.suspicion);
    EXPECT_FALSE(verdict_.alarm);
  }
}

TEST_F(DetectorAcceptTest, AResumedAlarmDoesNotWaitForWhoMayBeSilent) {
  Suspect dead;
  dead.id = kNew;
  dead.component = kTypes[kNew].source;
  dead.reason.kind = Kind::kDied;
  for (const bool before : {false, true}) {
    make();
    if (before) {
      detector_->accept(of(kNew, Kind::kDied));
    }
    detector_->resume({dead});
    if (!before) {
      windows(100);
      EXPECT_TRUE(verdict_.alarm) << "it is not heard";
      detector_->accept(of(kKnown, Kind::kDied));
      windows(100);
      EXPECT_TRUE(verdict_.alarm) << "another one is accepted";
      detector_->accept(of(kNew, Kind::kDied));
    }
    windows(40);
    EXPECT_FALSE(verdict_.alarm) << before;
  }
}

}  // namespace
}  // namespace self_awareness::core
