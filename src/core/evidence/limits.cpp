#include "self_awareness/core/evidence/limits.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/evidence/limit_search.h"
#include "core/evidence/misleading_pairs.h"
#include "core/evidence/relations.h"
#include "core/evidence/scorer.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::evidence {
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

void LimitFinder::startRecording(std::shared_ptr<const Model> model, std::int64_t robot_start) {
  finish();
  judging_ = std::move(model);
  robot_start_ = robot_start;
  startScoring();
}

void LimitFinder::startScoring() {
  scorer_ = std::make_unique<Scorer>(judging_, parameters_.window);
  if (second_pass_) {
    scorer_->capAt(limits_);  // as the detector does
  }
  recording_ = {};
  recording_.robot_start = robot_start_;
  recording_.trained_on = judging_ != model_;
  part_windows_ = static_cast<std::uint64_t>(std::max<std::int64_t>(
      toNanoseconds(model_->tuning().shortest_part) / parameters_.window, 1));
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

void LimitFinder::restart() {
  windows_.restart();
  onClockStep();
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

void LimitFinder::startSecondPass() {
  finish();
  if (model_->tracks().empty()) {
    throw std::invalid_argument("the model watches nothing, as no event type has " +
                                std::to_string(std::llround(model_->tuning().fewest_gaps)) +
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
  if (static_cast<std::int64_t>(windows) * parameters_.window <
      toNanoseconds(model_->tuning().least_time)) {
    throw std::invalid_argument("too little normal operation to find limits: at least " +
                                std::to_string(std::llround(model_->tuning().least_time)) +
                                " s are needed after the first seconds of every recording");
  }
  findRelations();
  const LimitSearch search(*model_, findings_, relations_, parameters_);
  limits_.tracks = search.limits();
  tracks_rate_ = search.rate();
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

void LimitFinder::findRelations() {
  const Relations relations(model_->statistics(), graph_, model_->tuning());
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
          as_usual.push_back({recording.start, recording.end, recording.robot_start});
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

Limits LimitFinder::limits() const {
  if (linker_findings_.empty()) {
    throw std::logic_error("limits are known after the second pass");
  }
  Limits limits = limits_;
  limits.linker = LimitSearch::linker(linker_findings_, parameters_, model_->tuning()).limit;
  return limits;
}

double LimitFinder::expectedRate() const {
  if (linker_findings_.empty()) {
    throw std::logic_error("the expected rate is known after the second pass");
  }
  return tracks_rate_ + LimitSearch::linker(linker_findings_, parameters_, model_->tuning()).rate;
}

}  // namespace self_awareness::core::evidence
