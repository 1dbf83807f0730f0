#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <vector>

#include "../tracks.h"
#include "core/evidence/excuse/busy_machine.h"
#include "core/evidence/excuse/stopped_together.h"

/// What holds for all excuses, whatever a robot does (docs/method.md, section 6).
namespace self_awareness::core::evidence {
namespace {

constexpr EventId kComponents = 12;
constexpr std::int64_t kEnd = 100 * kSecond;

// All at random; the second half of them hears the first half.
Events robot(std::int64_t start, unsigned seed) {
  return atRandom(kComponents, start, kEnd, 200 * kMillisecond, seed);
}

class ExcusesTest : public testing::Test {
 protected:
  ExcusesTest() {
    for (EventId id = 0; id < kComponents / 2; ++id) {
      graph_->connect(types_[id].source, types_[id].scope, types_[kComponents / 2 + id].source);
    }
  }

  /// A moment of a robot with faults drawn at random: who is silent since when, and who is slow.
  void draw(unsigned seed) {
    std::mt19937 random(seed);
    const auto chance = [&](double share) { return std::bernoulli_distribution(share)(random); };
    const double silent = chance(0.5) ? 0.6 : 0.2;
    const double slow = chance(0.7) ? 0.9 : 0.1;
    const std::int64_t stop = std::uniform_int_distribution<std::int64_t>(3, 40)(random) * kSecond;
    std::vector<std::int64_t> ages;
    std::vector<bool> is_silent;
    for (EventId id = 0; id < kComponents; ++id) {
      is_silent.push_back(chance(silent));
      // Four that stopped before would be a mode of their own.
      const std::int64_t age = id % 4 > 0 || chance(0.5) ? stop : 3 * stop / 2;
      ages.push_back(is_silent.back() ? age : 0);
    }
    scorer_ = std::make_unique<Scorer>(heardLast(model_, ages, kEnd));
    std::vector<double> shares = allTracks(*model_, 0);
    for (EventId id = 0; id < kComponents; ++id) {
      ofTrack(shares, *model_, kOverdue, id) = is_silent[id] ? 2 : 0;
      ofTrack(shares, *model_, kSlower, id) = chance(slow) ? 1.5 : 0;
    }
    drawn_ = excessesOf(model_, shares, *scorer_);
    for (Excess& excess : drawn_) {  // some were so for long
      excess.onset -= chance(0.2) ? 60 * kSecond : 0;
    }
  }
  std::optional<Silent> stoppedTogether(std::vector<Excess>& excesses) {
    return StoppedTogether(model_, upstream_, graph_)
        .excuse(excesses, allLimits(*model_, 1), *scorer_, {},
                std::vector<bool>(model_->size(), false))
        .silent;
  }
  std::optional<Busy> busyMachine(std::vector<Excess>& excesses) {
    return BusyMachine(model_, explanation_).excuse(excesses, *scorer_, events_);
  }
  static std::vector<bool> excused(const std::vector<Excess>& excesses) {
    std::vector<bool> excused;
    for (const Excess& excess : excesses) {
      excused.push_back(excess.excuse != Excuse::kNone);
    }
    return excused;
  }

  const std::vector<EventType> types_ = numberedTypes(kComponents);
  std::shared_ptr<SourceGraph> graph_ = std::make_shared<SourceGraph>();
  std::shared_ptr<const Model> model_ = std::make_shared<Model>(
      watchAll(countsOf({robot(0, 100)}, types_), countsOf({robot(kStart, 200)}, types_)));
  std::shared_ptr<const Upstream> upstream_ =
      std::make_shared<Upstream>(model_->components(), graph_);
  Explanation explanation_{model_, upstream_};
  RecentEvents events_{model_->size()};
  std::unique_ptr<Scorer> scorer_;
  std::vector<Excess> drawn_;
};

TEST_F(ExcusesTest, TheirOrderDoesNotMatter) {
  int both = 0;
  for (unsigned seed = 0; seed < 500; ++seed) {
    draw(seed);
    std::vector<Excess> first = drawn_;
    std::vector<Excess> second = drawn_;
    const bool stopped = stoppedTogether(first).has_value();
    const bool busy = busyMachine(first).has_value();
    both += stopped && busy ? 1 : 0;
    EXPECT_EQ(busyMachine(second).has_value(), busy) << seed;
    EXPECT_EQ(stoppedTogether(second).has_value(), stopped) << seed;
    EXPECT_EQ(excused(first), excused(second)) << seed;
  }
  EXPECT_GT(both, 10);
}

TEST_F(ExcusesTest, WhatBeganBeforeAnExcuseIsNotCovered) {
  int excuses = 0;
  for (unsigned seed = 0; seed < 500; ++seed) {
    draw(seed);
    for (const bool is_busy : {false, true}) {
      std::vector<Excess> excesses = drawn_;
      std::optional<std::int64_t> since;
      if (is_busy) {
        const std::optional<Busy> busy = busyMachine(excesses);
        since = busy ? std::optional(busy->since) : std::nullopt;
      } else if (const std::optional<Silent> silent = stoppedTogether(excesses)) {
        since = silent->since;
      }
      excuses += since ? 1 : 0;
      for (const Excess& excess : excesses) {
        const EventId id = model_->tracks()[excess.track].to;
        const std::int64_t before =
            is_busy ? excess.onset : scorer_->heard().stamps()[id] + model_->longestGap(id);
        EXPECT_TRUE(excess.excuse == Excuse::kNone || before + kRateSpan >= since.value()) << seed;
      }
    }
  }
  EXPECT_GT(excuses, 50);
}

}  // namespace
}  // namespace self_awareness::core::evidence
