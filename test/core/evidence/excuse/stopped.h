#pragma once

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../tracks.h"
#include "core/evidence/excuse/excuses.h"
#include "core/evidence/excuse/new_mode.h"
#include "core/evidence/excuse/silent_together.h"

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
    events_.emplace(model_->size());
    shares_ = allTracks(*model_, 0);
    beginAnew();
  }
  void beginAnew() {
    const std::vector<bool> may_be_silent =
        moment_ ? moment_->may_be_silent : std::vector<bool>(model_->size(), false);
    const std::map<std::string, std::int64_t> strangers =
        moment_ ? moment_->strangers : std::map<std::string, std::int64_t>();
    moment_ = std::make_unique<Moment>(model_, graph_);
    moment_->may_be_silent = may_be_silent;
    moment_->strangers = strangers;
    Excuses::List list;
    list.push_back(std::make_unique<NewMode>(model_));
    list.push_back(std::make_unique<SilentTogether>(model_, graph_));
    together_ = std::make_unique<Excuses>(model_, std::move(list));
  }
  double& share(EventId id) { return ofTrack(shares_, *model_, kOverdue, id); }
  /// Shares of what is excused become 0.
  Judgement excuseIn(const Scorer& scorer) {
    std::vector<Excess> excesses = excessesOf(model_, shares_, scorer);
    for (Excess& excess : excesses) {
      const auto abnormal = abnormal_.find(excess.id);
      excess.abnormal = abnormal == abnormal_.end() ? kNotYet : abnormal->second;
    }
    Judgement judgement;
    together_->closeWindow(excesses, moment_->in(excesses, scorer, *events_), judgement);
    excused_.clear();
    for (const Excess& excess : excesses) {
      excused_.push_back(excess.excused);
      shares_[excess.track] = excess.excused == Excused::kNo ? shares_[excess.track] : 0;
    }
    return judgement;
  }
  /// Judges who stopped so long ago [ns], all of them at a share of their limits.
  Judgement found(const std::vector<std::int64_t>& ages, std::int64_t now = kEnd,
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
  std::unique_ptr<Excuses> together_;
  std::unique_ptr<Moment> moment_;
  std::optional<RecentEvents> events_;
  std::vector<double> shares_;
  std::map<EventId, std::int64_t> abnormal_;  // since when [ns]
  std::vector<Excused> excused_;              // what was unusual, at last
};

}  // namespace self_awareness::core::evidence
