#include "self_awareness/core/training.h"

#include <stdexcept>
#include <utility>

#include "core/paper/delay_trainer.h"

namespace self_awareness::core {

struct Training::Trainers {
  Trainers(TrainingCounts& counts, std::int64_t window)
      : paper(counts.delays),
        evidence{evidence::Trainer(counts.halves[0], window),
                 evidence::Trainer(counts.halves[1], window)} {}

  paper::DelayTrainer paper;
  std::array<evidence::Trainer, 2> evidence;  // by half
};

Training::Training(const Parameters& parameters)
    : parameters_(parameters),
      counts_{paper::DelayStatistics(parameters.binning), {}},
      trainers_(std::make_unique<Trainers>(counts_, parameters.window)) {
  if (!parameters.evidence && !parameters.paper) {
    throw std::invalid_argument("a training must count for the evidence or the paper's detector");
  }
}

Training::~Training() = default;

EventId Training::intern(const EventType& type) {
  const EventId id = counts_.delays.intern(type);
  if (parameters_.evidence) {
    for (evidence::Statistics& half : counts_.halves) {
      half.intern(type);  // the same id
    }
  }
  return id;
}

std::size_t Training::startRecording(std::optional<std::int64_t> since, std::int64_t robot_start) {
  half_ = recordings_++ % counts_.halves.size();
  middle_.reset();
  trainers_->paper.startRecording();
  trainers_->evidence.at(half_).startRecording(since, robot_start);
  return half_;
}

void Training::startOnlyRecording(std::int64_t middle, std::optional<std::int64_t> since,
                                  std::int64_t robot_start) {
  if (recordings_ > 0) {
    throw std::logic_error("a recording that is to be cut in two is not the first one");
  }
  startRecording(since, robot_start);
  middle_ = middle;
  robot_start_ = robot_start;
}

void Training::addBefore(const Event& event) {
  if (parameters_.evidence) {
    trainers_->evidence.at(half_).addBefore(event);
  }
}

void Training::add(const Event& event) {
  if (parameters_.paper) {
    trainers_->paper.add(event);
  } else {
    counts_.delays.countEvent(event.id);
  }
  if (middle_ && event.stamp >= *middle_) {
    middle_.reset();
    half_ = 1;
    trainers_->evidence.at(half_).startRecording(std::nullopt, robot_start_);
  }
  if (parameters_.evidence) {
    trainers_->evidence.at(half_).add(event);
  }
}

TrainingCounts Training::finish() {
  if (!trainers_) {
    throw std::logic_error("the training is over: its counts were handed out");
  }
  for (evidence::Trainer& trainer : trainers_->evidence) {
    trainer.finish();
  }
  trainers_.reset();
  return std::move(counts_);
}

}  // namespace self_awareness::core
