#include "self_awareness/core/training.h"

#include <optional>
#include <stdexcept>
#include <utility>

#include "core/paper/delay_trainer.h"
#include "self_awareness/core/evidence/count/trainer.h"

namespace self_awareness::core {

struct Training::Trainers {
  Trainers(TrainingCounts& counts, std::int64_t window)
      : paper(counts.delays), evidence(counts.halves[0], window) {}

  paper::DelayTrainer paper;
  evidence::Trainer evidence;
};

Training::Training(const Parameters& parameters)
    : parameters_(parameters),
      counts_{paper::DelayStatistics(parameters.binning), {}, std::nullopt},
      trainers_(std::make_unique<Trainers>(counts_, parameters.window)) {
  if (!parameters.evidence && !parameters.paper) {
    throw std::invalid_argument("a training must count for the evidence or the paper's detector");
  }
}

Training::~Training() = default;

void Training::requireOpen() const {
  if (!trainers_) {
    throw std::logic_error("the training is over: its counts were handed out");
  }
}

EventId Training::intern(const EventType& type) {
  requireOpen();
  const EventId id = counts_.delays.intern(type);
  if (parameters_.evidence) {
    for (evidence::Statistics& half : counts_.halves) {
      half.intern(type);  // the same id
    }
  }
  return id;
}

void Training::startRecording(const Recording& recording) {
  requireOpen();
  trainers_->paper.startRecording();
  trainers_->evidence.startRecording(
      {recording.since, recording.robot_start, recording.robot, recording.stalls});
  const std::size_t half = evidence::halfOf(recording.fingerprint);
  if (!started_) {
    counts_.only_half = half;
  } else if (counts_.only_half && counts_.only_half != half) {
    evidence::joinParts(counts_.halves, *counts_.only_half);
    counts_.only_half.reset();
  }
  started_ = true;
  middle_ = counts_.only_half ? std::optional(recording.middle) : std::nullopt;
  trainers_->evidence.countInto(counts_.halves.at(counts_.only_half ? 0 : half));
}

void Training::onClockStep() {
  trainers_->paper.startRecording();
  trainers_->evidence.onClockStep();
}

void Training::addBefore(const Event& event) {
  if (parameters_.evidence) {
    trainers_->evidence.addBefore(event);
  }
}

void Training::add(const Event& event) {
  if (vocabulary().tellsMode(event.id)) {
    // The paper knows no modes.
  } else if (parameters_.paper) {
    trainers_->paper.add(event);
  } else {
    counts_.delays.countEvent(event.id);
  }
  if (middle_ && event.stamp >= *middle_) {
    middle_.reset();
    trainers_->evidence.countInto(counts_.halves[1]);
  }
  if (parameters_.evidence) {
    trainers_->evidence.add(event);
  }
}

TrainingCounts Training::finish() {
  requireOpen();
  trainers_->evidence.finish();
  trainers_.reset();
  return std::move(counts_);
}

}  // namespace self_awareness::core
