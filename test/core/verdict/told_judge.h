#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "self_awareness/core/verdict/detector.h"

/// A judge that says what it is told, for the tests of what the detector makes of it.
namespace self_awareness::core {

constexpr std::int64_t kWindow = 100000000;
constexpr std::int64_t kSecond = 10 * kWindow;
constexpr EventId kUnknownId = 7;

// Gives every window the judgement that the test wants. An event type is of the component of its
// number, such as "/7".
class ToldJudge : public Judge {
 public:
  explicit ToldJudge(std::shared_ptr<Judgement> told) : told_(std::move(told)) {}

  std::optional<ObservedEvent> add(const Event& event) override {
    const bool unknown = event.id == kUnknownId && !isAccepted(event.id, Kind::kStranger);
    return ObservedEvent{event, unknown, std::nullopt};
  }
  void accept(const Acceptances& accepted) override { accepted_ = accepted; }
  bool isAccepted(EventId id, Kind kind) const override {
    return accepted_.covers("/" + std::to_string(id), "", kind);
  }
  void settle(const Event& first, std::int64_t settle_time) override {
    settling_[first.id] = first.stamp + settle_time;
  }
  void leaveOut(const std::vector<EventId>& ids, std::int64_t until) override {
    for (const EventId id : ids) {
      settling_[id] = until;
    }
  }
  void standStill(const Waiting& /*pause*/, std::int64_t until) override { settled_at_ = until; }
  Judgement judge(const Window& window, std::int64_t /*end*/, NameSuspects suspects) override {
    Judgement judgement = *told_;
    judgement.settling = judgement.settling || window.start < settled_at_;
    if (suspects == NameSuspects::kAlways ||
        (suspects == NameSuspects::kIfUnusual && (judgement.abnormal || judgement.suspicious))) {
      if (judgement.suspects.empty()) {
        judgement.suspects = {Suspect{}};
      }
    } else {
      judgement.suspects.clear();
    }
    return judgement;
  }
  void restart() override {
    settling_.clear();
    settled_at_ = 0;
  }
  const std::map<EventId, std::int64_t>& settling() const { return settling_; }

 private:
  std::map<EventId, std::int64_t> settling_;
  std::int64_t settled_at_ = 0;
  std::shared_ptr<Judgement> told_;
  Acceptances accepted_;
};

// A detector that is told what its judge says.
class ToldTest : public testing::Test {
 protected:
  // Runs normal operation until the detector has settled.
  void start(UnknownEvents unknown = UnknownEvents::kWarn) {
    Detector::Parameters parameters;
    parameters.unknown = unknown;
    parameters.settle_time = kSecond;
    told_->threshold = -1;
    now_ = 0;
    auto judge = std::make_unique<ToldJudge>(told_);
    judge_ = judge.get();
    detector_ = std::make_unique<Detector>(std::move(judge), kWindow, parameters,
                                           [this](const Verdict& verdict) {
                                             verdict_ = verdict;
                                             changes_ += verdict.changed ? 1 : 0;
                                           });
    detector_->add({0, 0});
    windows(10);
  }
  // Passes one window, with an event if the test wants one.
  const Verdict& window(std::optional<EventId> id = std::nullopt) {
    if (id) {
      detector_->add({now_, *id});
    }
    detector_->advance(now_ += kWindow);
    return verdict_;
  }
  void windows(int number) {
    for (int i = 0; i < number; ++i) {
      window();
    }
  }
  // A suspect of the component, whose evidence alone is abnormal or not.
  static Suspect suspect(const std::string& component, EventId id, bool abnormal = true) {
    Suspect suspect;
    suspect.component = component;
    suspect.id = id;
    suspect.abnormal = abnormal;
    return suspect;
  }
  // Passes one certainly abnormal window with these suspects.
  const Verdict& alarmWindow(std::vector<Suspect> suspects) {
    told_->certain = true;
    told_->suspects = std::move(suspects);
    abnormalWindow();
    told_->certain = false;
    told_->suspects.clear();
    return verdict_;
  }
  const Verdict& abnormalWindow() {
    told_->abnormal = true;
    window();
    told_->abnormal = false;
    return verdict_;
  }

  std::shared_ptr<Judgement> told_ = std::make_shared<Judgement>();
  const ToldJudge* judge_ = nullptr;  // of the detector
  std::unique_ptr<Detector> detector_;
  std::int64_t now_ = 0;
  Verdict verdict_;
  int changes_ = 0;
};

}  // namespace self_awareness::core
