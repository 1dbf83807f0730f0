#include "core/evidence/excuse/excuses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "../../verdict/accepted.h"
#include "../tracks.h"

/// What holds for all excuses, whatever a robot does (docs/method.md, section 6).
namespace self_awareness::core::evidence {
namespace {

constexpr EventId kComponents = 12;
constexpr EventId kOnFirst = 4;  // of them on one computer, the others on another one
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
    for (EventId id = 0; id < kComponents; ++id) {
      graph_->place(types_[id].source, id < kOnFirst ? "first" : "second");
    }
  }

  /// A moment of a robot with faults drawn at random: who is silent since when, and who is slow;
  /// now and then all of a computer, or four of a mode that is accepted.
  void draw(unsigned seed) {
    std::mt19937 random(seed);
    const auto chance = [&](double share) { return std::bernoulli_distribution(share)(random); };
    const double silent = chance(0.5) ? 0.6 : 0.2;
    const double slow = chance(0.7) ? 0.9 : 0.1;
    const bool is_off = chance(0.1);  // all of the first computer
    const bool is_accepted = chance(0.2);
    const std::int64_t stop = std::uniform_int_distribution<std::int64_t>(3, 40)(random) * kSecond;
    std::vector<std::int64_t> ages;
    std::vector<bool> is_silent;
    for (EventId id = 0; id < kComponents; ++id) {
      is_silent.push_back((is_off && id < kOnFirst) || (is_accepted && id < 4) || chance(silent));
      // Four that stopped before would be a mode of their own.
      const std::int64_t age = id % 4 > 0 || chance(0.5) ? stop : 3 * stop / 2;
      ages.push_back(is_silent.back() ? age : 0);
    }
    accepted_ = {};
    if (is_accepted) {
      std::set<std::string> mode;
      for (EventId id = 0; id < kComponents; ++id) {
        if (is_silent[id]) {
          mode.insert(types_[id].source);
        }
      }
      accepted_ = allOf({acceptedMode({mode.begin(), mode.end()})});
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
    Excuses excuses(model_, std::move(list));
    excuses.accept(accepted_);
    Judgement judgement;
    excuses.closeWindow(excesses, moment_.in(excesses, *scorer_, events_), judgement);
    return judgement;
  }
  static auto all(const Judgement& judgement) {
    const Silent silent = judgement.silent.value_or(Silent{});
    const Busy busy = judgement.busy.value_or(Busy{});
    return std::tuple(silent.components, silent.hosts, silent.since, silent.others_go_on,
                      judgement.mode, busy.late, busy.since);
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
  Acceptances accepted_;
};

TEST_F(ExcusesTest, TheirOrderDoesNotMatterButThatWhatIsAcceptedIsKnownFirst) {
  std::map<Excused, int> seen;
  int both = 0;
  for (unsigned seed = 0; seed < 1000; ++seed) {
    draw(seed);
    std::vector<std::size_t> order(allExcuses(model_, graph_).size());
    std::iota(order.begin(), order.end(), 0);
    const auto first_that_moves = order.begin() + (accepted_.list().empty() ? 0 : 1);
    std::vector<Excess> first = drawn_;
    const Judgement told = excuse(order, first);
    const std::vector<Excused> reasons = excused(first);
    for (const Excused reason : std::set<Excused>(reasons.begin(), reasons.end())) {
      ++seen[reason];
    }
    both += told.busy && std::count(reasons.begin(), reasons.end(), Excused::kNewMode) > 0 ? 1 : 0;
    while (std::next_permutation(first_that_moves, order.end())) {
      std::vector<Excess> second = drawn_;
      EXPECT_EQ(all(excuse(order, second)), all(told)) << seed;
      EXPECT_EQ(excused(second), reasons) << seed;
    }
  }
  EXPECT_GT(both, 10);
  for (const Excused reason :
       {Excused::kAllSilent, Excused::kAccepted, Excused::kNewMode, Excused::kBusy}) {
    EXPECT_GT(seen[reason], 10) << static_cast<int>(reason);
  }
}

}  // namespace
}  // namespace self_awareness::core::evidence
