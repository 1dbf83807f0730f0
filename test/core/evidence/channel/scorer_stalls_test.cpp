// A whole robot that stops for a moment, topics that begin late, and what is silent alone.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <vector>

#include "../recordings.h"
#include "core/evidence/channel/scorer.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kPeriod = 100 * kMillisecond;
constexpr std::int64_t kStall = 500 * kMillisecond;
constexpr std::int64_t kFault = 20 * kSecond;

// Three timers, one of them a fast one; the phases are the same in every start.
Events robot(std::int64_t length) {
  return together({timer(kA, 0, length, kPeriod / 5),
                   timer(kB, 33 * kMillisecond, length, kPeriod),
                   timer(kC, 66 * kMillisecond, length, kPeriod)});
}

class ScorerStallsTest : public testing::Test {
 protected:
  ScorerStallsTest() { largest_ = largestEvidence(robot(2 * kFault)); }

  // The largest evidence of every track from kFault on.
  std::vector<double> largestEvidence(const Events& events,
                                      std::int64_t until = 2 * kFault) const {
    std::vector<double> largest(model_->tracks().size(), 0);
    scoreWindows(events, until, [&](std::int64_t end, const std::vector<double>& evidence) {
      for (std::size_t track = 0; track < largest.size() && end > kFault; ++track) {
        largest[track] = std::max(largest[track], evidence[track]);
      }
    });
    return largest;
  }
  // Tells of the evidence at the end of every window.
  template <typename OnWindow>
  void scoreWindows(const Events& events, std::int64_t until, OnWindow onWindow) const {
    Scorer scorer(model_, kWindow);
    auto event = events.begin();
    for (std::int64_t end = kWindow; end <= until; end += kWindow) {
      for (; event != events.end() && event->stamp < end; ++event) {
        scorer.add(*event);
      }
      onWindow(end, scorer.closeWindow(end));
    }
  }
  // Tracks whose evidence is no longer usual.
  std::vector<std::size_t> unusual(const std::vector<double>& evidence) const {
    std::vector<std::size_t> tracks;
    for (std::size_t track = 0; track < evidence.size(); ++track) {
      if (evidence[track] > std::max(1.25 * largest_[track], model_->leastLimit(track))) {
        tracks.push_back(track);
      }
    }
    return tracks;
  }
  // Time from kFault until a type is overdue [ns], if these events do not come any more.
  std::int64_t foundAfter(EventId id, const std::function<bool(EventId)>& dead) const {
    const Events events = without(robot(2 * kFault), [&](const Event& event) {
      return event.stamp >= kFault && dead(event.id);
    });
    const std::size_t overdue = indexOf(model_->tracks(), kOverdue, id, id);
    for (std::int64_t until = kFault + kWindow; until < 2 * kFault; until += kWindow) {
      if (largestEvidence(events, until)[overdue] > 1.25 * largest_[overdue]) {
        return until - kFault;
      }
    }
    return kFault;
  }

  std::shared_ptr<const Model> model_ = std::make_shared<Model>(
      watch(countsOf({robot(100 * kSecond)}), countsOf({later(robot(100 * kSecond))})));
  std::vector<double> largest_;
};

TEST_F(ScorerStallsTest, AMomentWithoutAnyEventIsNobodysFault) {
  Events waiting = robot(2 * kFault);  // all come at once at the end of the stall
  for (Event& event : waiting) {
    if (event.stamp >= kFault && event.stamp < kFault + kStall) {
      event.stamp = kFault + kStall;
    }
  }
  EXPECT_TRUE(unusual(largestEvidence(together({waiting}))).empty());
  const Events lost = without(robot(2 * kFault), [](const Event& event) {
    return event.stamp >= kFault && event.stamp < kFault + kStall;
  });
  EXPECT_TRUE(unusual(largestEvidence(lost)).empty());
}

TEST_F(ScorerStallsTest, PhasesMayBeOthersAfterwards) {
  const auto shifted = [](std::int64_t stall) {
    Events events = without(robot(2 * kFault), [&](const Event& event) {
      return event.stamp >= kFault && event.stamp < kFault + stall;
    });
    for (Event& event : events) {
      event.stamp += event.id == kB && event.stamp >= kFault + stall ? kPeriod / 4 : 0;
    }
    return together({events});
  };
  const auto unusual_pairs = [&](std::int64_t stall) {
    const std::vector<std::size_t> tracks = unusual(largestEvidence(shifted(stall)));
    return std::count_if(tracks.begin(), tracks.end(), [&](std::size_t track) {
      return channelName(model_->tracks()[track]) == kPairs;
    });
  };
  EXPECT_GT(unusual_pairs(0), 0);
  // So short that nobody but the fast one counts as restarted.
  EXPECT_EQ(unusual_pairs(3 * kPeriod), 0);
}

TEST_F(ScorerStallsTest, WhatIsSilentAloneIsMissing) {
  for (const EventId gone : {kA, kB, kC}) {
    const Events events = without(robot(2 * kFault), [&](const Event& event) {
      return event.id == gone && event.stamp >= kFault && event.stamp < kFault + kStall;
    });
    const std::vector<std::size_t> tracks = unusual(largestEvidence(events));
    EXPECT_TRUE(std::any_of(tracks.begin(), tracks.end(), [&](std::size_t track) {
      return channelName(model_->tracks()[track]) == kOverdue &&
             model_->tracks()[track].to == gone;
    })) << gone;
  }
}

TEST_F(ScorerStallsTest, ADeadRobotIsFoundALittleLaterThanADeadComponent) {
  const std::int64_t alone = foundAfter(kB, [](EventId id) { return id == kB; });
  const std::int64_t all = foundAfter(kB, [](EventId) { return true; });
  EXPECT_LE(alone, 500 * kMillisecond);
  EXPECT_GT(all, alone);
  EXPECT_LE(all, alone + 700 * kMillisecond);
}

TEST_F(ScorerStallsTest, WhoDoesNotComeBackAfterAStallIsMissing) {
  const Events events = without(robot(2 * kFault), [](const Event& event) {
    return event.stamp >= kFault && (event.id == kB || event.stamp < kFault + kStall);
  });
  const std::vector<std::size_t> tracks = unusual(largestEvidence(events));
  ASSERT_FALSE(tracks.empty());
  for (const std::size_t track : tracks) {
    EXPECT_EQ(model_->tracks()[track].to, kB) << track;
  }
}

}  // namespace
}  // namespace self_awareness::core::evidence
