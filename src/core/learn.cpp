#include "self_awareness/core/learn.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/paper/delay_trainer.h"
#include "self_awareness/core/evidence/count/halves.h"
#include "self_awareness/core/evidence/count/trainer.h"
#include "self_awareness/core/evidence/watch/machine_stalls.h"

namespace self_awareness::core {
namespace {

evidence::LimitFinder::Parameters ofFinder(const Calibrator::Parameters& parameters,
                                           std::int64_t window) {
  return {window, parameters.settle_time};
}

const Model& watched(const Model& model) {
  model.requireWatched();
  return model;
}

RecordingInfo infoOf(const Recording& recording, std::uint64_t fingerprint) {
  RecordingInfo info;
  info.bag = recording.name;
  info.start = recording.events.front().stamp;
  info.end = std::max(info.start, recording.events.back().stamp);
  info.events = recording.events.size();
  info.robot_start = recording.robot_start;
  info.robot = recording.robot;
  info.fingerprint = fingerprint;
  return info;
}

/// Index of the first event that is not before a time [ns]; their number if all are.
std::size_t firstFrom(const std::vector<Event>& events, std::int64_t time) {
  const auto first = std::find_if(events.begin(), events.end(),
                                  [time](const Event& event) { return event.stamp >= time; });
  return static_cast<std::size_t>(first - events.begin());
}

/// Calls onEvent() with each event of a part, and onStep() before one with which the clock was
/// set.
template <typename OnEvent, typename OnStep>
void forEachEvent(const Recording& recording, std::size_t begin, std::size_t end, OnEvent onEvent,
                  OnStep onStep) {
  for (std::size_t k = begin; k < end; ++k) {
    if (k > begin &&
        recording.clock_steps.between(recording.events[k - 1].stamp, recording.events[k].stamp)) {
      onStep();
    }
    onEvent(recording.events[k]);
  }
}

std::vector<evidence::MachineStall> stallsOf(const Recording& recording,
                                             const evidence::Tuning& tuning) {
  evidence::MachineStalls stalls(tuning);
  forEachEvent(
      recording, 0, recording.events.size(), [&](const Event& event) { stalls.add(event.stamp); },
      [&] { stalls.restart(); });
  return stalls.find();
}

}  // namespace

std::int64_t middleOf(const std::vector<Event>& events) {
  return events.empty() ? 0 : middleOf(events.front().stamp, events.back().stamp);
}

Calibrator::Calibrator(const Model& model, const Parameters& parameters)
    : Calibrator(std::make_shared<evidence::CrossFit>(watched(model).watched),
                 ofFinder(parameters, model.window), model.graph, model.onlyHalf()) {}

Calibrator::Calibrator(std::shared_ptr<const evidence::CrossFit> models,
                       const evidence::LimitFinder::Parameters& parameters,
                       const SourceGraph& graph, std::optional<std::size_t> only_half)
    : models_(std::move(models)),
      finder_(models_->model(), parameters, graph),
      only_half_(only_half) {}

std::unique_ptr<Calibrator> Calibrator::part() const {
  return std::unique_ptr<Calibrator>(
      new Calibrator(models_, finder_.parameters(), finder_.graph(), only_half_));
}

void Calibrator::judge(const Recording& recording, std::size_t begin, std::size_t end,
                       std::optional<std::size_t> half) {
  finder_.startRecording(models_->judging(half), recording.robot_start, recording.robot);
  auto waiting = recording.waiting.begin();
  forEachEvent(
      recording, begin, end,
      [&](const Event& event) {
        waiting = hearUntil(event.stamp, waiting, recording.waiting.end(), finder_);
        finder_.add(event);
      },
      [this] { finder_.restart(); });
  finder_.finish();
}

void Calibrator::addTrainedOn(const Recording& recording) {
  if (!recording.fingerprint) {
    throw std::invalid_argument("the fingerprint of a recording of the training is not known");
  }
  const std::size_t size = recording.events.size();
  if (!only_half_) {
    judge(recording, 0, size, evidence::halfOf(*recording.fingerprint));
    return;
  }
  const std::int64_t middle = middleOf(recording.events);
  judge(recording, 0, firstFrom(recording.events, middle), 0);
  // The second part has a time before it in which the detector settles.
  judge(recording, firstFrom(recording.events, middle - finder_.parameters().settle_time), size,
        1);
}

void Calibrator::addHeldOut(const Recording& recording) {
  judge(recording, 0, recording.events.size(), std::nullopt);
}

Calibration Calibrator::find(double budget) const {
  const evidence::LimitFinder::Found found = finder_.find(budget);
  Calibration calibration;
  const bool held_out = std::any_of(findings().begin(), findings().end(),
                                    [](const auto& recording) { return !recording.trained_on; });
  calibration.method = held_out ? Calibration::kHeldOut : Calibration::kCrossFit;
  calibration.limits = found.limits;
  calibration.relations = found.relations;
  calibration.budget = budget;
  calibration.false_alarms_per_hour = found.promised_rate;
  calibration.windows = finder_.windows();
  return calibration;
}

struct Learner::Trainers {
  Trainers(Model& model, std::int64_t window)
      : paper(model.statistics), evidence(model.evidence[0], window) {}

  paper::DelayTrainer paper;
  evidence::Trainer evidence;
};

Learner::Learner(SourceGraph graph) : Learner(Parameters{}, std::move(graph)) {}

Learner::Learner(const Parameters& parameters, SourceGraph graph) : parameters_(parameters) {
  const Counting& counting = parameters_.counting;
  if (!counting.evidence && !counting.paper) {
    throw std::invalid_argument("what is learned is for the evidence or the paper's detector");
  }
  parameters_.tuning.validate();
  ofFinder(parameters_.limits, counting.window).validate();
  model_.window = counting.window;
  model_.statistics = paper::DelayStatistics(counting.binning);
  model_.tuning = parameters_.tuning;
  model_.graph = std::move(graph);
  trainers_ = std::make_unique<Trainers>(model_, counting.window);
}

Learner::~Learner() = default;

void Learner::requireOpen() const {
  if (!trainers_) {
    throw std::logic_error("the learning is over: its model was handed out");
  }
}

EventId Learner::intern(const EventType& type) {
  requireOpen();
  const EventId id = model_.statistics.intern(type);
  if (parameters_.counting.evidence) {
    for (evidence::Statistics& half : model_.evidence) {
      half.intern(type);  // the same id
    }
  }
  return id;
}

void Learner::count(const Recording& recording) {
  requireOpen();
  if (recording.events.empty()) {
    throw std::invalid_argument("a recording without events");
  }
  const std::uint64_t fingerprint = recording.fingerprint.value_or(model_.recordings.size());
  startRecording(recording, fingerprint);
  if (parameters_.counting.evidence) {
    for (const Event& event : recording.before) {
      trainers_->evidence.addBefore(event);
    }
  }
  forEachEvent(
      recording, 0, recording.events.size(), [this](const Event& event) { countEvent(event); },
      [this] {
        trainers_->paper.startRecording();
        trainers_->evidence.onClockStep();
      });
  model_.recordings.push_back(infoOf(recording, fingerprint));
}

void Learner::startRecording(const Recording& recording, std::uint64_t fingerprint) {
  trainers_->paper.startRecording();
  trainers_->evidence.startRecording({recording.since, recording.robot_start, recording.robot,
                                      stallsOf(recording, parameters_.tuning)});
  const std::size_t half = evidence::halfOf(fingerprint);
  if (model_.recordings.empty()) {
    only_half_ = half;
  } else if (only_half_ && only_half_ != half) {
    evidence::joinParts(model_.evidence, *only_half_);
    only_half_.reset();
  }
  middle_ = only_half_ ? std::optional(middleOf(recording.events)) : std::nullopt;
  trainers_->evidence.countInto(model_.evidence.at(only_half_ ? 0 : half));
}

void Learner::countEvent(const Event& event) {
  if (!vocabulary().isMessage(event.id)) {
    // The paper knows no modes, and nothing without delays.
  } else if (parameters_.counting.paper) {
    trainers_->paper.add(event);
  } else {
    model_.statistics.countEvent(event.id);
  }
  if (middle_ && event.stamp >= *middle_) {
    middle_.reset();
    trainers_->evidence.countInto(model_.evidence[1]);
  }
  if (parameters_.counting.evidence) {
    trainers_->evidence.add(event);
  }
}

void Learner::add(Recording recording) {
  if (!recording.fingerprint) {
    recording.fingerprint = model_.recordings.size();
  }
  count(recording);
  kept_.push_back(std::move(recording));
}

Model Learner::counts() {
  requireOpen();
  trainers_->evidence.finish();
  trainers_.reset();
  return std::exchange(model_, {});
}

Model Learner::learn() {
  if (model_.recordings.empty()) {
    throw std::logic_error("there is no recording to learn from, or the learning has ended");
  }
  Model model = counts();
  const std::vector<Recording> recordings = std::exchange(kept_, {});
  if (!parameters_.counting.evidence) {
    why_ = "it was not learned for the evidence detector";
    return model;
  }
  model.watch();
  Calibrator calibrator(model, parameters_.limits);
  for (const Recording& recording : recordings) {
    calibrator.addTrainedOn(recording);
  }
  model.findings = calibrator.findings();
  try {
    model.calibration = calibrator.find();
    model.calibration->recordings = model.recordings;
  } catch (const std::invalid_argument& error) {
    why_ = error.what();
  }
  return model;
}

}  // namespace self_awareness::core
