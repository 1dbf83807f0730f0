#include <pybind11/stl.h>

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "reading.h"
#include "self_awareness/ros/bag_reader.h"
#include "self_awareness/ros/model_file.h"

namespace self_awareness::python {
namespace {

// Every pair of event types has a histogram: a field that is no small set of values, such as an
// identifier, would fill the memory long before it taught anything.
constexpr std::size_t kMostTypesOfField = 1000;

/// Trains on one recording after the other.
class Training {
 public:
  Training(ros1::EncodingRules rules, std::int64_t bin_size, std::int64_t window,
           std::int64_t horizon_bins, std::size_t predecessors)
      : statistics_(core::Binning{bin_size, horizon_bins}),
        trainer_(statistics_),
        evidence_trainers_{core::EvidenceTrainer(evidence_[0], window),
                           core::EvidenceTrainer(evidence_[1], window)},
        rules_(std::move(rules)),
        window_(window),
        predecessors_(predecessors) {}

  self_awareness::Recording addBag(const std::string& path, const ros1::TimeRange& range,
                                   bool alone, const py::object& progress) {
    const ros1::BagReader reader(path);
    const ros1::Encoder encoder(rules_,
                                [this](const core::EventType& type) { return intern(type); });
    self_awareness::Recording recording;
    recording.bag = path.substr(path.find_last_of('/') + 1);
    recording.fingerprint = reader.summary().fingerprint;
    const auto [from, to] = reader.limits(range);
    startRecording(alone ? std::optional<std::int64_t>(from + (to - from) / 2) : std::nullopt);
    reader.read(
        encoder, range,
        [&](const core::Event& event) {
          add(event);
          recording.start.fromNSec(recording.events == 0 ? event.stamp : recording.start.toNSec());
          recording.end.fromNSec(event.stamp);
          ++recording.events;
        },
        progressTo(progress));
    recordings_.push_back(recording);
    return recording;
  }

  void addEvents(const std::vector<core::EventType>& types, const Stamps& stamps, const Ids& ids,
                 bool alone) {
    startRecording(alone && stamps.size() > 0
                       ? std::optional<std::int64_t>(
                             stamps.at(0) + (stamps.at(stamps.size() - 1) - stamps.at(0)) / 2)
                       : std::nullopt);
    std::vector<std::optional<core::EventId>> here(types.size());
    forEachEvent(stamps, ids, [&](const core::Event& event) {
      std::optional<core::EventId>& id = here.at(event.id);
      if (!id) {
        id = intern(types[event.id]);
      }
      add({event.stamp, *id});
    });
  }

  ros1::TrainedModel model() const {
    ros1::TrainedModel model;
    model.encoding = rules_;
    model.window = window_;
    model.statistics = statistics_;
    model.evidence = evidence_;
    model.predecessors = predecessors_;
    model.watch();
    model.recordings = recordings_;
    model.stamp.fromSec(std::floor(ros::WallTime::now().toSec()));
    return model;
  }

 private:
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
    for (core::EvidenceStatistics& half : evidence_) {
      half.intern(type);  // the same id
    }
    const std::size_t datatype_end = type.type.find('[');
    if (statistics_.vocabulary().size() > before && datatype_end != std::string::npos) {
      const std::string datatype = type.type.substr(0, datatype_end);
      if (++types_of_field_[datatype] > kMostTypesOfField) {
        throw std::invalid_argument(
            "the type field " + datatype + ": " + rules_.type_fields.at(datatype) +
            " has more than " + std::to_string(kMostTypesOfField) +
            " values; name a field that says what a message does, or none for this datatype");
      }
    }
    return id;
  }

  core::DelayStatistics statistics_;
  core::DelayTrainer trainer_;
  std::array<core::EvidenceStatistics, 2> evidence_;
  std::array<core::EvidenceTrainer, 2> evidence_trainers_;
  std::size_t recording_ = 0;
  std::size_t half_ = 0;                // that is trained
  std::optional<std::int64_t> middle_;  // of a recording that is alone [ns], while before it
  ros1::EncodingRules rules_;
  std::int64_t window_;
  std::size_t predecessors_;
  std::map<std::string, std::size_t> types_of_field_;  // by datatype
  std::vector<self_awareness::Recording> recordings_;
};

}  // namespace

void bindTraining(py::module& m) {
  py::class_<Training>(m, "Training", "Counts the delays of one recording after the other.")
      .def(py::init<ros1::EncodingRules, std::int64_t, std::int64_t, std::int64_t, std::size_t>(),
           py::arg("encoding"), py::arg("bin_size") = 10000000, py::arg("window") = 100000000,
           py::arg("horizon_bins") = 0, py::arg("predecessors") = core::kPredecessors,
           "bin_size, window: [ns]; horizon_bins 0: unbounded; predecessors: most of an event "
           "type\n"
           "that the evidence watches")
      .def(
          "add_bag",
          [](Training& self, const std::string& path, std::optional<double> start,
             std::optional<double> end, bool alone, const py::object& progress) {
            return self.addBag(path, timeRange(start, end), alone, progress);
          },
          py::arg("path"), py::arg("start") = py::none(), py::arg("end") = py::none(),
          py::arg("alone") = false, py::arg("progress") = py::none(),
          "Trains on a bag, one recording; returns its Recording. start, end: seconds from its\n"
          "first message. alone: there is no other recording. After a BagError the training is "
          "incomplete and must be thrown away.")
      .def("add_events", &Training::addEvents, py::arg("event_types"), py::arg("stamps"),
           py::arg("ids"), py::arg("alone") = false, "Trains on one recording given as arrays.")
      .def("model", &Training::model, "The TrainedModel of all that was added.");
}

}  // namespace self_awareness::python
