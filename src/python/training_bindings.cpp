#include <pybind11/stl.h>

#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/model/model_file.h"

namespace self_awareness::python {
namespace {

/// Trains on one recording after the other.
class Training {
 public:
  Training(ros1::EncodingRules rules, std::int64_t bin_size, std::int64_t window,
           std::int64_t horizon_bins, std::size_t predecessors)
      : statistics_(core::paper::Binning{bin_size, horizon_bins}),
        trainer_(statistics_),
        evidence_trainers_{core::evidence::Trainer(evidence_[0], window),
                           core::evidence::Trainer(evidence_[1], window)},
        rules_(std::move(rules)),
        window_(window),
        predecessors_(predecessors) {}

  void addEvents(const std::vector<core::EventType>& types, const Stamps& stamps, const Ids& ids,
                 std::optional<std::int64_t> middle,
                 const std::optional<self_awareness::Recording>& recording) {
    checkNotEnded();
    startRecording(middle);
    std::vector<std::optional<core::EventId>> here(types.size());
    const py::gil_scoped_release release;
    forEachEvent(stamps, ids, [&](const core::Event& event) {
      std::optional<core::EventId>& id = here.at(event.id);
      if (!id) {
        id = intern(types[event.id]);
      }
      add({event.stamp, *id});
    });
    if (recording) {
      recordings_.push_back(*recording);
    }
  }

  // Not a copy: with many event types, the counts may fill half of the memory.
  ros1::TrainedModel model(bool watch) {
    checkNotEnded();
    ended_ = true;
    ros1::TrainedModel model;
    model.encoding = rules_;
    model.window = window_;
    model.statistics = std::move(statistics_);
    model.evidence = std::move(evidence_);
    model.predecessors = predecessors_;
    if (watch) {
      model.watch();
    }
    model.recordings = std::move(recordings_);
    model.stamp.fromSec(std::floor(ros::WallTime::now().toSec()));
    return model;
  }

 private:
  void checkNotEnded() const {
    if (ended_) {
      throw std::invalid_argument("the training has handed out its model, and is over");
    }
  }

  // Recordings belong to the two halves in turn. One that is alone is cut in the middle: what
  // holds for one half of it only is at least not taken for information.
  void startRecording(std::optional<std::int64_t> middle) {
    trainer_.startRecording();
    half_ = middle ? 0 : recording_++ % evidence_.size();
    middle_ = middle;
    evidence_trainers_.at(half_).startRecording();
  }

  void add(const core::Event& event) {
    trainer_.add(event);
    if (middle_ && event.stamp >= *middle_) {
      middle_.reset();
      half_ = 1;
      evidence_trainers_.at(half_).startRecording();
    }
    evidence_trainers_.at(half_).add(event);
  }

  core::EventId intern(const core::EventType& type) {
    const std::size_t before = statistics_.vocabulary().size();
    const core::EventId id = statistics_.intern(type);
    for (core::evidence::Statistics& half : evidence_) {
      half.intern(type);  // the same id
    }
    if (statistics_.vocabulary().size() > before) {
      ros1::checkTypeFields(rules_, statistics_.vocabulary());
    }
    return id;
  }

  core::paper::DelayStatistics statistics_;
  core::paper::DelayTrainer trainer_;
  std::array<core::evidence::Statistics, 2> evidence_;
  std::array<core::evidence::Trainer, 2> evidence_trainers_;
  std::size_t recording_ = 0;
  std::size_t half_ = 0;                // that is trained
  std::optional<std::int64_t> middle_;  // of a recording that is alone [ns], while before it
  ros1::EncodingRules rules_;
  std::int64_t window_;
  std::size_t predecessors_;
  std::vector<self_awareness::Recording> recordings_;
  bool ended_ = false;
};

}  // namespace

void bindTraining(py::module& m) {
  py::class_<Training>(m, "Training", "Counts the delays of one recording after the other.")
      .def(py::init<ros1::EncodingRules, std::int64_t, std::int64_t, std::int64_t, std::size_t>(),
           py::arg("encoding"), py::arg("bin_size") = 10000000, py::arg("window") = 100000000,
           py::arg("horizon_bins") = 0, py::arg("predecessors") = core::evidence::kPredecessors,
           "bin_size, window: [ns]; horizon_bins 0: unbounded; predecessors: most of an event "
           "type\n"
           "that the evidence watches")
      .def(
          "add_events", &Training::addEvents, py::arg("event_types"), py::arg("stamps"),
          py::arg("ids"), py::arg("middle") = py::none(), py::arg("recording") = py::none(),
          "Trains on one recording given as arrays; ids are indices of event_types. middle: "
          "[ns],\n"
          "of a recording that is alone: what comes before it is one half of the training, the\n"
          "rest the other. recording: what the model says of it. After a ValueError the training\n"
          "is incomplete and must be thrown away.")
      .def("model", &Training::model, py::arg("watch") = true,
           "The TrainedModel of all that was added; ends the training. watch: choose what is\n"
           "watched; not needed where it is merged.");
}

}  // namespace self_awareness::python
