#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "../tracks.h"
#include "core/evidence/channel/scorer.h"
#include "core/evidence/watch/recent_events.h"

namespace self_awareness::core::evidence {

constexpr std::int64_t kPeriod = 200 * kMillisecond;
constexpr std::int64_t kUsual = 20 * kMillisecond;
constexpr std::int64_t kUnusual = 60 * kMillisecond;
constexpr int kArming = 30;  // events
constexpr double kLimit = 14;
constexpr std::int64_t kAccepted = 60 * kSecond;

/// What a channel says of a recording, track by track.
class ChannelTest : public testing::Test {
 protected:
  explicit ChannelTest(Watched watched) : watched_(std::move(watched)) {}

  std::size_t track(const std::string& channel, EventId to, EventId from) const {
    const std::size_t index = indexOf(model_->tracks(), channel, to, from);
    EXPECT_LT(index, model_->tracks().size());
    return index;
  }
  void add(const Event& event) {
    scorer_.add(event);
    events_.add(event, scorer_.stalled());
  }
  void restart() {
    scorer_.restart();
    events_.restart();
  }
  /// Gives every track the same limit.
  void useLimits() { scorer_.capAt(allLimits(*model_, kLimit)); }
  double evidence(std::size_t track) { return scorer_.closeWindow(now_)[track]; }
  /// What a suspect is told of, at the end of a window.
  Suspect suspect(std::size_t track) {
    scorer_.closeWindow(now_);
    Suspect suspect;
    suspect.id = model_->tracks()[track].to;
    scorer_.explain(track, events_, suspect);
    return suspect;
  }

  Watched watched_;
  std::shared_ptr<const Model> model_ = std::make_shared<Model>(watched_);
  Scorer scorer_{model_, kWindow};
  RecentEvents events_{model_->size()};
  std::int64_t now_ = 10 * kStart;
};

/// What a channel says of one track.
class TrackTest : public testing::Test {
 protected:
  void learn(const Watched& watched, const std::string& channel, EventId to, EventId from) {
    model_ = std::make_shared<Model>(watched);
    track_ = indexOf(model_->tracks(), channel, to, from);
    scorer_ = std::make_unique<Scorer>(model_, kWindow);
  }
  double evidenceAt(std::int64_t stamp) { return scorer_->closeWindow(stamp)[track_]; }
  Reason reason() const {
    Suspect suspect;
    suspect.id = model_->tracks().at(track_).to;
    scorer_->explain(track_, RecentEvents(model_->size()), suspect);
    return suspect.reason;
  }

  std::shared_ptr<const Model> model_;
  std::size_t track_ = 0;
  std::unique_ptr<Scorer> scorer_;
};

/// A comes irregularly, and B kUsual after it.
class FollowedTest : public ChannelTest {
 protected:
  FollowedTest() : ChannelTest(watch(startOf(followed(1), 1, 2), startOf(followed(2), 2, 2))) {}

  /// Adds an A, and a B so many ns later; none: no B. Closes a window.
  void ask(std::optional<std::int64_t> delay) {
    add({now_, kA});
    if (delay) {
      add({now_ + *delay, kB});
    }
    now_ += kPeriod;
    scorer_.closeWindow(now_);
  }
  void askUsually(int times) {
    for (int i = 0; i < times; ++i) {
      ask(kUsual);
    }
  }
};

}  // namespace self_awareness::core::evidence
