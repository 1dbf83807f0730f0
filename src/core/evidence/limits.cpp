#include "self_awareness/core/evidence/limits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/evidence/held_out.h"
#include "core/evidence/misleading_pairs.h"
#include "core/evidence/relations.h"
#include "core/evidence/scorer.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::evidence {
namespace {

constexpr double kHour = 3600e9;  // [ns]
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// What was seen once in normal operation is normal, and so is a little more (docs/method.md,
// section 5.2).
constexpr double kLeastMargin = 1.25;
// More would find nothing any more: where the data say so, the budget cannot be kept.
constexpr double kMostMargin = 4;
constexpr double kMostGapMargin = 1.6;  // of the longest gaps: what is silent is to be found soon
constexpr double kMostOwnMargin = 2;    // of one track
// The linker depends on what the robot is doing, and that changes from hour to hour.
constexpr double kLeastLinkerMargin = 1.5;
constexpr double kLeastLinkerLimit = 2;  // event types
// An answer may take so many times the longest wait that was seen.
constexpr double kLeastDeadlineMargin = 2;
// By how much recordings exceed each other on average (a logarithm), as long as little is known.
constexpr double kScale = 0.2;
constexpr double kScaleOfTimers = 0.05;
// A gap shorter than this many mean gaps is one of a timer that lost nothing.
constexpr double kRegular = 1.5;
// A timer with shorter mean gaps, in windows, exceeds them by the host's hiccups.
constexpr double kFast = 2;

// Evidence that takes longer than this [ns] after a component's death is of no use.
constexpr double kLongestWait = 10e9;
constexpr double kLongestDeadline = 20;  // [s]
// A pair with a larger limit would need 20 or more improbable delays in a row.
constexpr double kMostDelayLimit = 100;
// An event type that may wait longer than this many mean gaps comes when something happens.
constexpr double kMostMeanGaps = 3;
// The gaps of what comes irregularly have a tail of their own.
constexpr std::size_t kTailGaps = 20;

/// Tracks whose values exceed those of other recordings in the same way share what they show.
enum class Pool {
  kFastTimers,
  kTimers,
  kOthers,
  kRates,
  kDelays,
  kSlowDelays,
  kAnswers,
  kDeadlines
};
// Each pool and the linker have an equal share of the budget, but slow delays, which raise no
// alarm.
constexpr double kShares = 8;

Pool poolOf(Channel channel) {
  switch (channel) {
    case Channel::kOverdue:
      return Pool::kOthers;
    case Channel::kFewer:
    case Channel::kMore:
      return Pool::kRates;
    case Channel::kDelay:
      return Pool::kDelays;
    case Channel::kSlowDelay:
      return Pool::kSlowDelays;
    case Channel::kAnswer:
      return Pool::kAnswers;
    case Channel::kDeadline:
      break;
  }
  return Pool::kDeadlines;
}

double leastMargin(Pool pool) {
  return pool == Pool::kDeadlines ? kLeastDeadlineMargin : kLeastMargin;
}

/// A track and its largest values.
struct Seen {
  std::size_t track = 0;
  double least = 0;             // limit
  std::vector<double> largest;  // by part
};

/// Age [ns] that gaps between two events of a type reach less often than a rate says: the excess
/// of the longest gaps over the shortest of them is taken for exponential, and extrapolated
/// (docs/method.md, section 5.3).
/// @param longest_gaps [ns], the longest first, at least one
/// @param hours in which they were the longest
/// @param rate of such gaps an hour
double tailOfGaps(const std::vector<std::int64_t>& longest_gaps, double hours, double rate) {
  const std::size_t number = std::min(longest_gaps.size(), kTailGaps);
  const auto shortest = static_cast<double>(longest_gaps[number - 1]);
  const double mean =
      std::accumulate(longest_gaps.begin(),
                      longest_gaps.begin() + static_cast<std::ptrdiff_t>(number), 0.0) /
      static_cast<double>(number);
  const double expected = static_cast<double>(number) / (hours * rate);
  return shortest + (mean - shortest) * std::max(std::log(expected), 0.0);
}

/// Numbers the starts that recordings belong to.
std::vector<std::size_t> startsOf(const std::vector<Span>& recordings) {
  std::vector<std::size_t> starts;
  for (const Span& recording : recordings) {
    std::vector<Span> before;
    for (const Span& other : recordings) {
      if (other <= recording) {
        before.push_back(other);
      }
    }
    starts.push_back(numberOfStarts(before) - 1);
  }
  return starts;
}

}  // namespace

void LimitFinder::Parameters::validate() const {
  if (window <= 0 || settle_time < 0) {
    throw std::invalid_argument("window must be more than 0 ns, settle_time 0 or more");
  }
  if (!(false_alarms_per_hour > 0) || !std::isfinite(false_alarms_per_hour)) {
    throw std::invalid_argument("the budget of false alarms an hour must be more than 0");
  }
}

LimitFinder::LimitFinder(std::shared_ptr<const Model> model, const Parameters& parameters,
                         SourceGraph graph)
    : model_(std::move(model)),
      parameters_(parameters),
      graph_(std::move(graph)),
      windows_(parameters.window, *this),
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
  recording_ = {};
  recording_.trained_on = judging_ != model_;
  part_windows_ =
      static_cast<std::uint64_t>(std::max<std::int64_t>(kShortestPart / parameters_.window, 1));
}

void LimitFinder::add(const Event& event) {
  windows_.add(event);
}

ObservedEvent LimitFinder::observe(const Event& event) {
  if (!first_stamp_) {
    first_stamp_ = event.stamp;
    recording_.start = event.stamp;
    startPart();
  }
  recording_.end = event.stamp;
  const ObservedEvent observed{event, !model_->knows(event.id), scorer_->add(event)};
  if (!second_pass_ && !observed.unknown) {
    if (observed.gap) {
      std::int64_t& longest = recording_.parts.back().longest_gaps[event.id];
      longest = std::max(longest, *observed.gap);
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

void LimitFinder::startPart() {
  if (recording_.parts.size() == kMostParts) {
    joinParts();
  }
  Recording::Part part;
  part.evidence.resize(second_pass_ ? 0 : model_->tracks().size());
  part.longest_gaps.resize(second_pass_ ? 0 : model_->size());
  recording_.parts.push_back(std::move(part));
}

void LimitFinder::joinParts() {
  const auto largest = [](auto& values, const auto& others) {
    std::transform(values.begin(), values.end(), others.begin(), values.begin(),
                   [](auto a, auto b) { return std::max(a, b); });
  };
  for (std::size_t k = 0; k < kMostParts / 2; ++k) {
    Recording::Part& part = recording_.parts[2 * k];
    const Recording::Part& next = recording_.parts[2 * k + 1];
    part.windows += next.windows;
    part.linker = std::max(part.linker, next.linker);
    largest(part.evidence, next.evidence);
    largest(part.longest_gaps, next.longest_gaps);
    if (k > 0) {
      recording_.parts[k] = std::move(part);
    }
  }
  recording_.parts.resize(kMostParts / 2);
  part_windows_ *= 2;
}

void LimitFinder::endRecording() {
  if (!first_stamp_) {
    return;
  }
  first_stamp_.reset();
  if (!second_pass_) {
    misleading_->finish();
    for (const MisleadingPairs::Said said : misleading_->takeFindings()) {
      recording_.said.push_back(static_cast<Said>(said));
    }
  }
  (second_pass_ ? linker_findings_ : findings_).push_back(std::move(recording_));
  recording_ = {};
}

void LimitFinder::close(const Window& window, std::int64_t end) {
  if (end < window.start + parameters_.window) {
    return;  // the recording ends within its last window
  }
  const std::vector<double>& evidence = scorer_->closeWindow(end);
  if (end - parameters_.window < *first_stamp_ + parameters_.settle_time) {
    return;
  }
  if (recording_.parts.back().windows == part_windows_) {
    startPart();
  }
  Recording::Part& part = recording_.parts.back();
  ++part.windows;
  ++recording_.windows;
  if (second_pass_) {
    part.linker =
        std::max(part.linker, static_cast<float>(sumUp(evidence, *judging_, limits_).linker));
    return;
  }
  for (std::size_t track = 0; track < evidence.size(); ++track) {
    if (model_->tracks()[track].channel != Channel::kOverdue) {
      part.evidence[track] = std::max(part.evidence[track], static_cast<float>(evidence[track]));
    }
  }
}

std::uint64_t LimitFinder::windows() const {
  std::uint64_t windows = 0;
  for (const Recording& recording : findings_) {
    windows += recording.windows;
  }
  return windows;
}

double LimitFinder::hoursOf(std::uint64_t windows) const {
  return static_cast<double>(windows) * static_cast<double>(parameters_.window) / kHour;
}

void LimitFinder::startSecondPass() {
  finish();
  if (model_->tracks().empty()) {
    throw std::invalid_argument("the model watches nothing, as no event type has " +
                                std::to_string(kFewestGaps) +
                                " gaps in its training: train it on more");
  }
  // What the training showed does not replace recordings that it has never seen.
  const bool held_out =
      std::any_of(findings_.begin(), findings_.end(),
                  [](const Recording& recording) { return !recording.trained_on; });
  std::uint64_t windows = 0;
  for (const Recording& recording : findings_) {
    windows += recording.trained_on && held_out ? 0 : recording.windows;
  }
  if (static_cast<std::int64_t>(windows) * parameters_.window < kLeastTime) {
    throw std::invalid_argument("too little normal operation to find limits: at least " +
                                std::to_string(kLeastTime / kNanosecondsPerSecond) +
                                " s are needed after the first seconds of every recording");
  }
  findRelations();
  findLimits();
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

void LimitFinder::merge(const Findings& other) {
  for (const Recording& recording : other) {
    for (const Recording::Part& part : recording.parts) {
      if (!second_pass_ && (part.evidence.size() != model_->tracks().size() ||
                            part.longest_gaps.size() != model_->size())) {
        throw std::invalid_argument("the findings are those of another model");
      }
    }
  }
  Findings& mine = second_pass_ ? linker_findings_ : findings_;
  mine.insert(mine.end(), other.begin(), other.end());
}

double LimitFinder::meanGap(EventId id) const {
  const Statistics::Type& type = model_->statistics().type(id);
  return static_cast<double>(type.gap_sum) / static_cast<double>(type.gaps);
}

void LimitFinder::findRelations() {
  const Relations relations(model_->statistics(), graph_);
  for (std::size_t track = 0; track < model_->tracks().size(); ++track) {
    const auto& [channel, to, from] = model_->tracks()[track];
    Relation relation;
    if (channel == Channel::kAnswer) {
      relation = relations.answers(from, to);
    } else if (channel == Channel::kDeadline) {
      relation = relations.deadline(from, to);
    } else if (channel == Channel::kDelay || channel == Channel::kSlowDelay) {
      std::vector<Span> as_usual;
      for (const Recording& recording : findings_) {
        if (!recording.trained_on && recording.said[track] == Said::kAsUsual) {
          as_usual.emplace_back(recording.start, recording.end);
        }
      }
      relation = relations.delays(from, to, as_usual);
      for (const Recording& recording : findings_) {
        relation.watched &= from == to || recording.said[track] != Said::kMisleading;
      }
    } else {
      relation.watched = true;
    }
    relations_.push_back(relation);
  }
}

void LimitFinder::findLimits() {
  // Of the training, the gaps of each recording are known; the other evidence only where its
  // recordings were judged by each other.
  std::vector<Part> judged;
  std::vector<Part> with_gaps;
  std::vector<const Recording::Part*> judged_parts;
  std::vector<const Recording::Part*> gap_parts;
  std::vector<Span> spans;
  const std::vector<Statistics::Recording>& training = model_->statistics().recordings();
  for (const Statistics::Recording& recording : training) {
    spans.emplace_back(recording.start, recording.end);
  }
  for (const Recording& recording : findings_) {
    spans.emplace_back(recording.start, recording.end);
  }
  const std::vector<std::size_t> starts = startsOf(spans);
  for (std::size_t k = 0; k < training.size(); ++k) {
    with_gaps.push_back(
        {starts[k], static_cast<double>(training[k].end - training[k].start) / kHour});
  }
  for (std::size_t k = 0; k < findings_.size(); ++k) {
    for (const Recording::Part& part : findings_[k].parts) {
      const Part hours{starts[training.size() + k], hoursOf(part.windows)};
      judged.push_back(hours);
      judged_parts.push_back(&part);
      if (!findings_[k].trained_on) {
        with_gaps.push_back(hours);
        gap_parts.push_back(&part);
      }
    }
  }

  std::map<Pool, std::vector<Seen>> pools;
  for (std::size_t track = 0; track < model_->tracks().size(); ++track) {
    const auto& [channel, to, from] = model_->tracks()[track];
    Seen seen{track, model_->leastLimit(track), {}};
    Pool pool = poolOf(channel);
    if (channel == Channel::kOverdue) {
      for (const Statistics::Recording& recording : training) {
        seen.largest.push_back(to < recording.longest_gaps.size()
                                   ? static_cast<double>(recording.longest_gaps[to])
                                   : 0);
      }
      for (const Recording::Part* part : gap_parts) {
        seen.largest.push_back(static_cast<double>(part->longest_gaps[to]));
      }
      // Windows tell ages no better than this, and hiccups of a host add to a gap, however long.
      for (double& gap : seen.largest) {
        gap += gap > 0 ? static_cast<double>(parameters_.window) : 0;
      }
      std::vector<double> sorted = seen.largest;
      std::sort(sorted.rbegin(), sorted.rend());
      const double second = sorted.size() > 1 && sorted[1] > 0 ? sorted[1] : sorted[0];
      const auto window = static_cast<double>(parameters_.window);
      pool = second - window >= kRegular * meanGap(to) ? Pool::kOthers
             : meanGap(to) < kFast * window            ? Pool::kFastTimers
                                                       : Pool::kTimers;
    } else {
      for (const Recording::Part* part : judged_parts) {
        seen.largest.push_back(part->evidence[track]);
      }
    }
    if (relations_[track].watched) {
      pools[pool].push_back(std::move(seen));
    }
  }

  double hours_with_gaps = 0;
  for (const Part& part : with_gaps) {
    hours_with_gaps += part.hours;
  }
  limits_.tracks.assign(model_->tracks().size(), kNone);
  tracks_rate_ = 0;
  for (const auto& [pool, tracks] : pools) {
    const bool timers = pool == Pool::kTimers || pool == Pool::kFastTimers;
    const bool gaps = timers || pool == Pool::kOthers;
    HeldOut held_out(gaps ? with_gaps : judged, timers ? kScaleOfTimers : kScale);
    for (const Seen& seen : tracks) {
      held_out.add(seen.largest, seen.least);
    }
    const double margin =
        std::min(held_out.margin(parameters_.false_alarms_per_hour / kShares, leastMargin(pool)),
                 gaps ? kMostGapMargin : kMostMargin);
    tracks_rate_ += pool == Pool::kSlowDelays ? 0 : held_out.rate(margin);
    for (const Seen& seen : tracks) {
      const auto& [channel, to, from] = model_->tracks()[seen.track];
      // A track that would have raised an alarm had its worst start been left out gets a wider
      // limit.
      const double own =
          gaps ? margin
               : std::max(margin,
                          std::min(held_out.excess(seen.largest, seen.least), kMostOwnMargin));
      const double largest = *std::max_element(seen.largest.begin(), seen.largest.end());
      const double found =
          std::max(seen.least, own * std::max(largest, HeldOut::kLeastShare * seen.least));
      double& limit = limits_.tracks[seen.track];
      if (channel == Channel::kOverdue) {
        // What comes when something happens may stay away for as long as nothing does.
        double age = found - static_cast<double>(parameters_.window);
        if (pool == Pool::kOthers) {
          Statistics::Type gaps = model_->statistics().type(to);
          for (const Recording::Part* part : gap_parts) {
            gaps.addGap(part->longest_gaps[to]);
          }
          const double rate =
              parameters_.false_alarms_per_hour / kShares / static_cast<double>(tracks.size());
          age = std::max(age, tailOfGaps(gaps.longest_gaps, hours_with_gaps, rate));
        }
        const bool irregular = age > kLongestWait && age > kMostMeanGaps * meanGap(to);
        limit = irregular ? kNone : model_->overdue(to, std::llround(age));
      } else if (channel == Channel::kDelay || channel == Channel::kSlowDelay) {
        limit = found > kMostDelayLimit ? kNone : found;
      } else if (channel == Channel::kAnswer) {
        limit = found / model_->missed(seen.track) * meanGap(from) > kLongestWait ? kNone : found;
      } else if (channel == Channel::kDeadline) {
        const double seconds = model_->countsRequests(seen.track)
                                   ? found * model_->usualDelay(from, from, 0.5)
                                   : found;
        limit = seconds > kLongestDeadline ? kNone : found;
      } else {
        limit = found;
      }
    }
  }
}

namespace {

/// The linker's largest values in all parts.
struct LinkerParts {
  std::vector<Part> parts;
  std::vector<double> largest;
};

LinkerParts linkerParts(const LimitFinder::Findings& findings, std::int64_t window) {
  LinkerParts all;
  std::vector<Span> spans;
  for (const LimitFinder::Recording& recording : findings) {
    spans.emplace_back(recording.start, recording.end);
  }
  const std::vector<std::size_t> starts = startsOf(spans);
  for (std::size_t k = 0; k < findings.size(); ++k) {
    for (const LimitFinder::Recording::Part& part : findings[k].parts) {
      all.parts.push_back(
          {starts[k], static_cast<double>(part.windows) * static_cast<double>(window) / kHour});
      all.largest.push_back(part.linker);
    }
  }
  return all;
}

}  // namespace

Limits LimitFinder::limits() const {
  if (linker_findings_.empty()) {
    throw std::logic_error("limits are known after the second pass");
  }
  const LinkerParts seen = linkerParts(linker_findings_, parameters_.window);
  HeldOut held_out(seen.parts, kScale);
  held_out.add(seen.largest, kLeastLinkerLimit);
  const double margin =
      held_out.margin(parameters_.false_alarms_per_hour / kShares, kLeastLinkerMargin);
  const double largest = *std::max_element(seen.largest.begin(), seen.largest.end());
  Limits limits = limits_;
  limits.linker = std::max(kLeastLinkerLimit,
                           margin * std::max(largest, HeldOut::kLeastShare * kLeastLinkerLimit));
  return limits;
}

double LimitFinder::expectedRate() const {
  const LinkerParts seen = linkerParts(linker_findings_, parameters_.window);
  HeldOut held_out(seen.parts, kScale);
  held_out.add(seen.largest, kLeastLinkerLimit);
  return tracks_rate_ + held_out.rate(held_out.margin(parameters_.false_alarms_per_hour / kShares,
                                                      kLeastLinkerMargin));
}

}  // namespace self_awareness::core::evidence
