#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "self_awareness/core/evidence/watch/machine_stalls.h"
#include "self_awareness/core/learn.h"
#include "self_awareness/core/training.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/model/model_file.h"

namespace self_awareness::python {
namespace {

std::int64_t middleOf(const Stamps& stamps) {
  if (stamps.ndim() != 1 || stamps.size() == 0) {
    return 0;
  }
  return core::middleOf(stamps.at(0), stamps.at(stamps.size() - 1));
}

/// A training, and what its model holds besides the counts.
class Training {
 public:
  Training(ros1::EncodingRules rules, const core::Training::Parameters& parameters,
           const core::evidence::Tuning& tuning)
      : training_(parameters),
        rules_(std::move(rules)),
        window_(parameters.window),
        tuning_(tuning) {
    tuning.validate();
  }

  void addEvents(const std::vector<core::EventType>& types, const Stamps& stamps, const Ids& ids,
                 const std::optional<core::RecordingInfo>& recording,
                 const std::optional<std::pair<Stamps, Ids>>& before,
                 std::vector<std::int64_t> clock_steps, const MessageAttributes& attributes) {
    checkNotEnded();
    core::Training::Recording start;
    start.middle = middleOf(stamps);
    if (before && before->first.size() > 0) {
      start.since = before->first.at(0);
    }
    if (recording) {
      start.fingerprint = recording->fingerprint;
      start.robot_start = recording->robot_start;
      start.robot = recording->robot;
    }
    const core::ClockSteps steps(std::move(clock_steps));
    start.stalls = stallsOf(stamps, steps);
    training_.startRecording(start);
    if (before) {
      addBefore(types, *before);
    }
    std::vector<std::optional<core::EventId>> here(types.size());
    const py::gil_scoped_release release;
    const auto add = [&](const core::Event& event) {
      std::optional<core::EventId>& id = here.at(event.id);
      if (!id) {
        id = intern(types[event.id]);
      }
      training_.add({event.stamp, *id, event.attributes});
    };
    forEachEvent(stamps, ids, attributes, steps, add, [&] { training_.onClockStep(); });
    if (recording) {
      recordings_.push_back(*recording);
    }
  }

  ros1::TrainedModel model(bool watch) {
    checkNotEnded();
    ended_ = true;
    core::TrainingCounts counts = training_.finish();
    ros1::TrainedModel model;
    model.encoding = rules_;
    model.window = window_;
    model.statistics = std::move(counts.delays);
    model.evidence = std::move(counts.halves);
    model.tuning = tuning_;
    if (watch) {
      model.watch();
    }
    model.recordings = std::move(recordings_);
    model.stamp = now();
    return model;
  }

 private:
  void addBefore(const std::vector<core::EventType>& types, const std::pair<Stamps, Ids>& before) {
    for (const core::EventType& type : types) {
      intern(type);  // first, so that ids are in the order of the part
    }
    forEachEvent(before.first, before.second, [&](const core::Event& event) {
      if (event.id < types.size()) {
        training_.addBefore({event.stamp, intern(types[event.id])});
      }
    });
  }

  std::vector<core::evidence::MachineStall> stallsOf(const Stamps& stamps,
                                                     const core::ClockSteps& steps) const {
    core::evidence::MachineStalls stalls(tuning_);
    for (py::ssize_t k = 0; k < stamps.size(); ++k) {
      if (k > 0 && steps.between(stamps.at(k - 1), stamps.at(k))) {
        stalls.restart();
      }
      stalls.add(stamps.at(k));
    }
    return stalls.find();
  }

  void checkNotEnded() const {
    if (ended_) {
      throw std::invalid_argument("the training has handed out its model, and is over");
    }
  }

  core::EventId intern(const core::EventType& type) {
    const std::size_t before = training_.vocabulary().size();
    const core::EventId id = training_.intern(type);
    if (training_.vocabulary().size() > before) {
      ros1::checkEventTypes(rules_, training_.vocabulary());
    }
    return id;
  }

  core::Training training_;
  ros1::EncodingRules rules_;
  std::int64_t window_;
  core::evidence::Tuning tuning_;
  std::vector<core::RecordingInfo> recordings_;
  bool ended_ = false;
};

}  // namespace

void bindTraining(py::module& m) {
  m.def("half_of", &core::evidence::halfOf, py::arg("fingerprint"),
        "The half of a training that a recording belongs to, 0 or 1.");

  py::class_<Training>(m, "Training", "Trains on one recording after the other.")
      .def(py::init([](ros1::EncodingRules rules, std::int64_t bin_size, std::int64_t window,
                       std::int64_t horizon_bins, bool evidence, bool paper,
                       const core::evidence::Tuning& tuning) {
             core::Training::Parameters parameters;
             parameters.evidence = evidence;
             parameters.paper = paper;
             parameters.window = window;
             parameters.binning = {bin_size, horizon_bins};
             return std::make_unique<Training>(std::move(rules), parameters, tuning);
           }),
           py::arg("encoding"), py::arg("bin_size") = core::paper::Binning{}.bin_size,
           py::arg("window") = core::kDefaultWindow, py::arg("horizon_bins") = 0,
           py::arg("evidence") = true, py::arg("paper") = false,
           py::arg("tuning") = core::evidence::Tuning{},
           "bin_size, window: [ns]; horizon_bins 0: unbounded; tuning: the numbers of the\n"
           "evidence detector")
      .def("add_events", &Training::addEvents, py::arg("event_types"), py::arg("stamps"),
           py::arg("ids"), py::arg("recording") = py::none(), py::arg("before") = py::none(),
           py::arg("clock_steps") = std::vector<std::int64_t>(),
           py::arg("attributes") = py::none(),
           "Trains on one recording given as arrays; ids are indices of event_types.\n"
           "recording: what the model says about it; its fingerprint says which half of the\n"
           "training it belongs to (half_of); None: the first one.\n"
           "before: stamps and ids of the events of the recording before these, which only say\n"
           "when event types came first; ids from len(event_types) on are of no type of these.\n"
           "clock_steps: with which the clock was set forward (find_clock_steps).\n"
           "attributes: of the messages (RecordedEvents.attributes), None: not known.\n"
           "After a ValueError the training is incomplete: do not use it any more.")
      .def(
          "model", &Training::model, py::arg("watch") = true,
          "Ends the training; returns the TrainedModel of all that was added. watch: choose what\n"
          "is watched; not needed for a model that is merged into another.");
}

}  // namespace self_awareness::python
