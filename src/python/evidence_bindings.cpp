#include <pybind11/stl.h>

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bindings.h"
#include "self_awareness/core/evidence_limits.h"
#include "self_awareness/core/evidence_model.h"
#include "self_awareness/ros/model_file.h"

namespace self_awareness::python {
namespace {

using core::EvidenceModel;

std::shared_ptr<EvidenceModel> makeModel(
    const ros1::TrainedModel& trained,
    EvidenceModel::Learned learned = EvidenceModel::Learned::kBoth) {
  return std::make_shared<EvidenceModel>(trained.watched, learned);
}

/// Finds limits on recordings that come twice each: as held-out data, or, where the model was
/// trained on them, judged by what the other half of the training says.
class Limits {
 public:
  Limits(const ros1::TrainedModel& trained, std::int64_t settle_time, double budget)
      : model_(makeModel(trained)),
        halves_{makeModel(trained, EvidenceModel::Learned::kSecond),
                makeModel(trained, EvidenceModel::Learned::kFirst)},
        finder_(model_, {trained.window, settle_time, budget}) {}

  void addEvents(const Stamps& stamps, const Ids& ids, std::optional<std::size_t> half) {
    finder_.startRecording(half ? halves_.at(*half) : model_);
    forEachEvent(stamps, ids, [&](const core::Event& event) { finder_.add(event); });
    finder_.finish();
  }
  void startSecondPass() { finder_.startSecondPass(); }
  core::EvidenceLimits limits() const { return finder_.limits(); }
  std::uint64_t windows() const { return finder_.windows(); }

 private:
  std::shared_ptr<EvidenceModel> model_;
  std::array<std::shared_ptr<EvidenceModel>, 2>
      halves_;  // that judge the half, not learned from it
  core::LimitFinder finder_;
};

/// Evidence of every track at the end of every window: [windows, tracks].
py::array_t<double> evidenceOf(const std::shared_ptr<EvidenceModel>& model, std::int64_t window,
                               const Stamps& stamps, const Ids& ids) {
  core::EvidenceScorer scorer(model, window);
  std::vector<double> rows;
  core::Windows windows(window, [&](const core::Window& closed) {
    const std::vector<double>& evidence = scorer.closeWindow(closed.start + window);
    rows.insert(rows.end(), evidence.begin(), evidence.end());
  });
  forEachEvent(stamps, ids, [&](const core::Event& event) {
    windows.advance(event.stamp);
    windows.add({event, 0, !model->knows(event.id), scorer.add(event)});
  });
  windows.finish();
  const std::size_t tracks = model->tracks().size();
  py::array_t<double> array({tracks == 0 ? 0 : rows.size() / tracks, tracks});
  std::copy(rows.begin(), rows.end(), array.mutable_data());
  return array;
}

}  // namespace

void bindEvidence(py::module& m) {
  using core::Track;
  py::class_<Track>(m, "Track", "One thing that the evidence detector watches.")
      .def_property_readonly(
          "channel", [](const Track& self) { return core::channelName(self.channel); },
          "overdue, rate, pairs or answers")
      .def_readonly("to_id", &Track::to)
      .def_readonly("from_id", &Track::from, "as to_id where one event type is looked at");

  py::class_<EvidenceModel, std::shared_ptr<EvidenceModel>>(
      m, "EvidenceModel", "What normal operation lets expect, from a TrainedModel's counts.")
      .def(py::init([](const ros1::TrainedModel& trained) { return makeModel(trained); }),
           py::arg("trained"))
      .def_property_readonly("tracks", &EvidenceModel::tracks)
      .def("overdue", &EvidenceModel::overdue, py::arg("id"), py::arg("age"), "age: [ns]")
      .def("log_survival", &EvidenceModel::logSurvival, py::arg("id"), py::arg("age"))
      .def("evidence", &evidenceOf, py::arg("window"), py::arg("stamps"), py::arg("ids"),
           "float64 [windows, tracks], at the end of every window of a recording");

  py::class_<core::EvidenceLimits>(m, "EvidenceLimits", "When evidence is abnormal.")
      .def_readonly("tracks", &core::EvidenceLimits::tracks, "by track; NaN: not judged")
      .def_readonly("linker", &core::EvidenceLimits::linker);

  py::class_<Limits>(m, "LimitFinder",
                     "Finds limits in two passes over the same recordings of normal operation.")
      .def(py::init<const ros1::TrainedModel&, std::int64_t, double>(), py::arg("trained"),
           py::arg("settle_time"), py::arg("budget"),
           "settle_time: [ns]; budget: false alarms an hour")
      .def("add_events", &Limits::addEvents, py::arg("stamps"), py::arg("ids"),
           py::arg("half") = py::none(),
           "A recording; half: 0 or 1 where that half of the training was trained on it.")
      .def("start_second_pass", &Limits::startSecondPass,
           "ValueError where the recordings were too short.")
      .def("limits", &Limits::limits)
      .def_property_readonly("windows", &Limits::windows);
}

}  // namespace self_awareness::python
