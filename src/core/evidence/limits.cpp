#include "self_awareness/core/evidence/limits.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/evidence/misleading_pairs.h"
#include "core/evidence/scorer.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::evidence {
namespace {

constexpr double kEulerMascheroni = 0.57721566490153286;
constexpr double kHour = 3600e9;  // [ns]
constexpr double kKinds = 4;      // of evidence: overdue, rate, pairs, answers

// What was seen once in normal operation is normal, and so is a little more (docs/method.md,
// section 5.3).
constexpr double kMargin = 1.25;
// The same for the longest gap (docs/method.md, section 5.2).
constexpr double kGapMargin = 1.1;
// The linker depends on what the robot is doing, and that changes from hour to hour.
constexpr double kLinkerMargin = 1.5;
constexpr std::size_t kTailGaps = 20;

// Evidence that takes longer than this [ns] after a component's death is of no use.
constexpr double kLongestWait = 10e9;
// A pair with a larger limit would need 20 or more improbable delays in a row.
constexpr double kMostDelayLimit = 100;
// An event type that may wait longer than this many mean gaps comes when something happens.
constexpr double kMostMeanGaps = 3;

}  // namespace

double gumbelLimit(const BlockMaxima& maxima, double probability) {
  const auto n = static_cast<double>(maxima.number());
  double mean = 0;
  double weighted = 0;
  double rank = 0;  // of the cell's first maximum, from 0
  for (const auto& [maximum, cell_count] : maxima.cells()) {
    const double count = cell_count;
    const double ranks = count * (rank + (count - 1) / 2);  // their sum
    mean += maximum * count / n;
    weighted += ranks / (n - 1) * maximum / n;
    rank += count;
  }
  const double scale = (2 * weighted - mean) / std::log(2.0);
  const double location = mean - kEulerMascheroni * scale;
  return location - scale * std::log(-std::log1p(-probability));
}

double overdueAge(const std::vector<std::int64_t>& longest_gaps, std::int64_t duration,
                  double rate) {
  const std::size_t number = std::min(longest_gaps.size(), kTailGaps);
  const auto shortest = static_cast<double>(longest_gaps[number - 1]);
  const double mean = std::accumulate(longest_gaps.begin(),
                                      longest_gaps.begin() + static_cast<long>(number), 0.0) /
                      static_cast<double>(number);
  const double expected = static_cast<double>(number) / (static_cast<double>(duration) * rate);
  return std::max(shortest + (mean - shortest) * std::max(std::log(expected), 0.0),
                  kGapMargin * static_cast<double>(longest_gaps.front()));
}

void LimitFinder::Parameters::validate() const {
  if (window <= 0 || settle_time < 0) {
    throw std::invalid_argument("window must be more than 0 ns, settle_time 0 or more");
  }
  if (!(false_alarms_per_hour > 0) || !std::isfinite(false_alarms_per_hour)) {
    throw std::invalid_argument("the budget of false alarms an hour must be more than 0");
  }
}

LimitFinder::LimitFinder(std::shared_ptr<const Model> model, const Parameters& parameters)
    : model_(std::move(model)),
      parameters_(parameters),
      windows_(parameters.window, *this),
      block_(model_->tracks().size(), 0),
      maxima_(model_->tracks().size()),
      gaps_(model_->size()),
      misleading_(std::make_unique<MisleadingPairs>(*model_)) {
  parameters_.validate();
}

LimitFinder::~LimitFinder() = default;

void LimitFinder::startRecording(std::shared_ptr<const Model> model) {
  finish();
  judging_ = std::move(model);
  startScoring();
}

void LimitFinder::startScoring() {
  scorer_ = std::make_unique<Scorer>(judging_, parameters_.window);
  if (second_pass_) {
    scorer_->capAt(limits_);  // as the detector does
  }
}

void LimitFinder::add(const Event& event) {
  windows_.add(event);
}

ObservedEvent LimitFinder::observe(const Event& event) {
  if (!first_stamp_) {
    first_stamp_ = event.stamp;
  }
  last_stamp_ = event.stamp;
  const ObservedEvent observed{event, !model_->knows(event.id), scorer_->add(event)};
  if (!second_pass_ && !observed.unknown) {
    if (observed.gap) {
      gaps_[event.id].addGap(*observed.gap);
    }
    misleading_->add(event);
  }
  return observed;
}

void LimitFinder::onClockStep() {
  endRecording();
  startScoring();
}

void LimitFinder::finish() {
  windows_.finish();
  endRecording();
}

void LimitFinder::endRecording() {
  if (!first_stamp_) {
    return;
  }
  closeBlock();
  if (!second_pass_) {
    misleading_->finish();
    duration_ += last_stamp_ - *first_stamp_;
  }
  first_stamp_.reset();
}

void LimitFinder::close(const Window& window, std::int64_t end) {
  if (end < window.start + parameters_.window) {
    return;  // the recording ends within its last window
  }
  const std::vector<double>& evidence = scorer_->closeWindow(end);
  if (end - parameters_.window < *first_stamp_ + parameters_.settle_time) {
    return;
  }
  ++block_windows_;
  if (second_pass_) {
    linker_block_ = std::max(linker_block_, sumUp(evidence, *judging_, limits_).linker);
  } else {
    ++windows_seen_;
    Eigen::Map<Eigen::ArrayXd> block(block_.data(), static_cast<Eigen::Index>(block_.size()));
    block = block.max(Eigen::Map<const Eigen::ArrayXd>(evidence.data(), block.size()));
  }
  if (static_cast<std::int64_t>(block_windows_) * parameters_.window >= kBlock) {
    closeBlock();
  }
}

void LimitFinder::closeBlock() {
  // A shorter block at the end of a recording would have a smaller maximum.
  if (static_cast<std::int64_t>(block_windows_) * parameters_.window >= kBlock) {
    if (second_pass_) {
      linker_maxima_.add(linker_block_);
    } else {
      ++blocks_;
      for (std::size_t track = 0; track < block_.size(); ++track) {
        if (model_->tracks()[track].channel != Channel::kOverdue) {
          maxima_[track].add(block_[track]);
        }
      }
    }
  }
  block_windows_ = 0;
  linker_block_ = 0;
  std::fill(block_.begin(), block_.end(), 0);
}

void LimitFinder::startSecondPass() {
  finish();
  if (maxima_.empty()) {
    throw std::invalid_argument("the model watches nothing, as no event type has " +
                                std::to_string(kFewestGaps) +
                                " gaps in its training: train it on more");
  }
  if (blocks_ < kFewestBlocks) {
    throw std::invalid_argument("too little normal operation to find limits: at least " +
                                std::to_string(kFewestBlocks * kBlock / kNanosecondsPerSecond) +
                                " s are needed in pieces of " +
                                std::to_string(kBlock / kNanosecondsPerSecond) +
                                " s, after the first seconds of every recording");
  }
  // Each kind of evidence gets an equal share of the budget, each track of a kind an equal share
  // of that.
  std::map<std::string, std::size_t> of_kind;
  for (const Track& track : model_->tracks()) {
    ++of_kind[channelName(track.channel)];
  }
  for (std::size_t track = 0; track < maxima_.size(); ++track) {
    const std::size_t number = of_kind.at(channelName(model_->tracks()[track].channel));
    limits_.tracks.push_back(
        limit(track, parameters_.false_alarms_per_hour / kKinds / static_cast<double>(number)));
  }
  second_pass_ = true;
}

void LimitFinder::startSecondPass(Limits limits) {
  if (limits.tracks.size() != model_->tracks().size()) {
    throw std::invalid_argument("the limits are those of another model");
  }
  finish();
  limits_ = std::move(limits);
  second_pass_ = true;
}

LimitFinder::Findings LimitFinder::findings() const {
  Findings found;
  found.windows = windows_seen_;
  found.duration = duration_;
  found.blocks = blocks_;
  found.maxima = maxima_;
  for (const Statistics::Type& type : gaps_) {
    found.longest_gaps.push_back(type.longest_gaps);
  }
  found.misleading = misleading_->tracks();
  found.linker_maxima = linker_maxima_;
  return found;
}

void LimitFinder::merge(const Findings& other) {
  if (other.maxima.size() != maxima_.size() || other.longest_gaps.size() != gaps_.size() ||
      other.misleading.size() != misleading_->tracks().size()) {
    throw std::invalid_argument("the findings are those of another model");
  }
  windows_seen_ += other.windows;
  duration_ += other.duration;
  blocks_ += other.blocks;
  for (std::size_t track = 0; track < maxima_.size(); ++track) {
    maxima_[track].merge(other.maxima[track]);
  }
  misleading_->add(other.misleading);
  for (std::size_t id = 0; id < gaps_.size(); ++id) {
    for (const std::int64_t gap : other.longest_gaps[id]) {
      gaps_[id].addGap(gap);
    }
  }
  linker_maxima_.merge(other.linker_maxima);
}

double LimitFinder::meanGap(EventId id) const {
  const Statistics::Type& type = model_->statistics().type(id);
  return static_cast<double>(type.gap_sum) / static_cast<double>(type.gaps);
}

double LimitFinder::limit(std::size_t track, double rate) const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const auto& [channel, to, from] = model_->tracks()[track];
  if (channel == Channel::kOverdue) {
    Statistics::Type gaps = model_->statistics().type(to);
    for (const std::int64_t gap : gaps_[to].longest_gaps) {
      gaps.addGap(gap);
    }
    const double age =
        overdueAge(gaps.longest_gaps, model_->statistics().duration() + duration_, rate / kHour);
    // What comes when something happens may stay away for as long as nothing does.
    const bool irregular = age > kLongestWait && age > kMostMeanGaps * meanGap(to);
    return irregular ? kNone : model_->overdue(to, std::llround(age));
  }
  const BlockMaxima& maxima = maxima_[track];
  const double found = std::max({model_->leastLimit(track), kMargin * maxima.largest(),
                                 gumbelLimit(maxima, std::min(rate * kBlock / kHour, 0.5))});
  if (channel == Channel::kDelay || channel == Channel::kSlowDelay) {
    return misleading_->tracks()[track] || found > kMostDelayLimit ? kNone : found;
  }
  if (channel == Channel::kAnswer) {
    return found / model_->missed(track) * meanGap(from) > kLongestWait ? kNone : found;
  }
  return found;
}

Limits LimitFinder::limits() const {
  if (linker_maxima_.number() < 2) {
    throw std::logic_error("limits are known after the second pass");
  }
  Limits limits = limits_;
  limits.linker =
      std::max({1.0, kLinkerMargin * linker_maxima_.largest(),
                gumbelLimit(linker_maxima_,
                            std::min(parameters_.false_alarms_per_hour * kBlock / kHour, 0.5))});
  return limits;
}

}  // namespace self_awareness::core::evidence
