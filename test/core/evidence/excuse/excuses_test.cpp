#include "core/evidence/excuse/excuses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <random>
#include <vector>

#include "../moment.h"

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
  /// What they say of that moment, in whatever order, and what they excuse.
  Judgement excuse(const std::vector<std::size_t>& order, std::vector<Excess>& excesses) {
    Excuses::List all = allExcuses(model_, graph_);
    Excuses::List list;
    for (const std::size_t each : order) {
      list.push_back(std::move(all.at(each)));
    }
    Judgement judgement;
    Excuses(model_, std::move(list))
        .closeWindow(excesses, moment_.in(excesses, *scorer_, events_), judgement);
    return judgement;
  }
  static std::vector<Excused> excused(const std::vector<Excess>& excesses) {
    std::vector<Excused> excused;
    for (const Excess& excess : excesses) {
      excused.push_back(excess.excused);
    }
    return excused;
  }

  const std::vector<EventType> types_ = numberedTypes(kComponents);
  std::shared_ptr<SourceGraph> graph_ = std::make_shared<SourceGraph>();
  std::shared_ptr<const Model> model_ = std::make_shared<Model>(
      watchAll(countsOf({robot(0, 100)}, types_), countsOf({robot(kStart, 200)}, types_)));
  Moment moment_{model_, graph_};
  RecentEvents events_{model_->size()};
  std::unique_ptr<Scorer> scorer_;
  std::vector<Excess> drawn_;
};

TEST_F(ExcusesTest, TheirOrderDoesNotMatter) {
  int both = 0;
  for (unsigned seed = 0; seed < 500; ++seed) {
    draw(seed);
    std::vector<std::size_t> order(allExcuses(model_, graph_).size());
    std::iota(order.begin(), order.end(), 0);
    std::vector<Excess> first = drawn_;
    const Judgement told = excuse(order, first);
    const std::vector<Excused> reasons = excused(first);
    both += told.busy && std::count(reasons.begin(), reasons.end(), Excused::kNewMode) > 0 ? 1 : 0;
    while (std::next_permutation(order.begin(), order.end())) {
      std::vector<Excess> second = drawn_;
      const Judgement again = excuse(order, second);
      EXPECT_EQ(again.busy.has_value(), told.busy.has_value()) << seed;
      EXPECT_EQ(again.silent.has_value(), told.silent.has_value()) << seed;
      EXPECT_EQ(excused(second), reasons) << seed;
    }
  }
  EXPECT_GT(both, 10);
}

TEST_F(ExcusesTest, WhatBeganBeforeAnExcuseIsNotCovered) {
  int excuses = 0;
  for (unsigned seed = 0; seed < 500; ++seed) {
    draw(seed);
    const std::size_t number = allExcuses(model_, graph_).size();
    for (std::size_t each = 0; each < number; ++each) {
      std::vector<Excess> excesses = drawn_;
      const Judgement told = excuse({each}, excesses);
      excuses += told.busy || told.silent ? 1 : 0;
      for (const Excess& excess : excesses) {
        if (excess.excused != Excused::kNo) {
          const std::int64_t usual = excess.isTooLittle() ? model_->longestPause(excess.id) : 0;
          EXPECT_GE(excess.onset + usual, told.busy ? told.busy->since : told.silent->since)
              << seed;
        }
      }
    }
  }
  EXPECT_GT(excuses, 50);
}

}  // namespace
}  // namespace self_awareness::core::evidence
