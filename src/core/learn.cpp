#include "self_awareness/core/learn.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

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

RecordingInfo infoOf(const Recording& recording) {
  RecordingInfo info;
  info.bag = recording.name;
  info.start = recording.events.front().stamp;
  info.end = recording.events.back().stamp;
  info.events = recording.events.size();
  info.robot_start = recording.robot_start;
  info.robot = recording.robot;
  info.fingerprint = *recording.fingerprint;
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

Learner::Learner(SourceGraph graph) : Learner(Parameters{}, std::move(graph)) {}

Learner::Learner(const Parameters& parameters, SourceGraph graph)
    : parameters_(parameters), training_(parameters.counting), graph_(std::move(graph)) {
  parameters_.tuning.validate();
  ofFinder(parameters_.limits, parameters_.counting.window).validate();
}

void Learner::add(Recording recording) {
  if (recording.events.empty()) {
    throw std::invalid_argument("a recording without events");
  }
  if (!recording.fingerprint) {
    recording.fingerprint = recordings_.size();
  }
  training_.startRecording({*recording.fingerprint, middleOf(recording.events), std::nullopt,
                            recording.robot_start, recording.robot,
                            stallsOf(recording, parameters_.tuning)});
  forEachEvent(
      recording, 0, recording.events.size(), [this](const Event& event) { training_.add(event); },
      [this] { training_.onClockStep(); });
  recordings_.push_back(std::move(recording));
}

Model Learner::learn() {
  if (recordings_.empty()) {
    throw std::logic_error("there is no recording to learn from, or the learning has ended");
  }
  Model model;
  TrainingCounts counts = training_.finish();
  model.window = parameters_.counting.window;
  model.statistics = std::move(counts.delays);
  model.evidence = std::move(counts.halves);
  model.tuning = parameters_.tuning;
  model.graph = std::move(graph_);
  for (const Recording& recording : recordings_) {
    model.recordings.push_back(infoOf(recording));
  }
  const std::vector<Recording> recordings = std::exchange(recordings_, {});
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
