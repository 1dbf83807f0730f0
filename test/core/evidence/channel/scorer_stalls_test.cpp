// A whole robot that stops for a moment, topics that begin late, and what is silent alone.

#include <gtest/gtest.h>

#include <algorithm>
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
  std::vector<double> largestEvidence(const Events& events) const {
    std::vector<double> largest(model_->tracks().size(), 0);
    Scorer scorer(model_, kWindow);
    auto event = events.begin();
    for (std::int64_t end = kWindow; end <= 2 * kFault; end += kWindow) {
      for (; event != events.end() && event->stamp < end; ++event) {
        scorer.add(*event);
      }
      const std::vector<double>& evidence = scorer.closeWindow(end);
      for (std::size_t track = 0; track < largest.size() && end > kFault; ++track) {
        largest[track] = std::max(largest[track], evidence[track]);
      }
    }
    return largest;
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
