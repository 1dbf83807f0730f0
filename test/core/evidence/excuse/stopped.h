#pragma once

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "../tracks.h"
#include "core/evidence/excuse/stopped_together.h"

/// Robots of which several stop at one moment.
namespace self_awareness::core::evidence {

using Strings = std::vector<std::string>;

constexpr std::int64_t kEnd = 100 * kSecond;
constexpr std::int64_t kAgo = 30 * kSecond;

/// What is excused of a moment of a robot, where every limit is 1.
class StoppedTest : public testing::Test {
 protected:
  explicit StoppedTest(std::vector<EventType> types) : types_(std::move(types)) {}

  /// @param start events of a start of the robot, by its time [ns] and a seed
  template <typename Start>
  void learn(const Start& start, const SourceGraph& graph = {}, const Tuning& tuning = {}) {
    model_ = std::make_shared<Model>(watch(countsOf({start(0, 100)}, types_),
                                           countsOf({start(kStart, 200)}, types_), graph, tuning));
    may_be_silent_.assign(model_->size(), false);
    shares_ = allTracks(*model_, 0);
    beginAnew();
  }
  void beginAnew() {
    together_ = std::make_unique<StoppedTogether>(
        model_, std::make_shared<Upstream>(model_->components(), graph_), graph_);
  }
  double& share(EventId id) { return ofTrack(shares_, *model_, kOverdue, id); }
  /// Shares of what is excused become 0.
  StoppedTogether::Found excuseIn(const Scorer& scorer) {
    std::vector<Excess> excesses = excessesOf(model_, shares_, scorer);
    for (Excess& excess : excesses) {
      const auto abnormal = abnormal_.find(model_->tracks()[excess.track].to);
      excess.abnormal = abnormal == abnormal_.end() ? kNotYet : abnormal->second;
    }
    StoppedTogether::Found found =
        together_->excuse(excesses, allLimits(*model_, 1), scorer, strangers_, may_be_silent_);
    for (const Excess& excess : excesses) {
      shares_[excess.track] = excess.excuse == Excuse::kNone ? shares_[excess.track] : 0;
    }
    return found;
  }
  /// Judges who stopped so long ago [ns], all of them at a share of their limits.
  StoppedTogether::Found found(const std::vector<std::int64_t>& ages, std::int64_t now = kEnd,
                               double reached = 2) {
    shares_ = allTracks(*model_, 0);
    for (EventId id = 0; id < types_.size(); ++id) {
      share(id) = ages[id] > 0 ? reached : 0;
    }
    return excuseIn(heardLast(model_, ages, now));
  }

  const std::vector<EventType> types_;
  std::shared_ptr<SourceGraph> graph_ = std::make_shared<SourceGraph>();
  std::shared_ptr<const Model> model_;
  std::unique_ptr<StoppedTogether> together_;
  std::map<std::string, std::int64_t> strangers_;
  std::vector<bool> may_be_silent_;
  std::vector<double> shares_;
  std::map<EventId, std::int64_t> abnormal_;  // since when [ns]
};

}  // namespace self_awareness::core::evidence
