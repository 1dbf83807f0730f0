#include <pybind11/stl.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "core/evidence/lanes.h"
#include "self_awareness/ros/model/model_file.h"

namespace self_awareness::python {
namespace {

namespace evidence = core::evidence;

/// What a whole recording says of each component, by stretch of time.
struct Lanes {
  std::vector<std::string> components;
  std::vector<evidence::Lanes::Column> columns;
};

py::array_t<float> sharesOf(const Lanes& lanes) {
  py::array_t<float> array({lanes.components.size(), lanes.columns.size()});
  auto values = array.mutable_unchecked<2>();
  for (std::size_t column = 0; column < lanes.columns.size(); ++column) {
    for (std::size_t component = 0; component < lanes.components.size(); ++component) {
      values(static_cast<py::ssize_t>(component), static_cast<py::ssize_t>(column)) =
          lanes.columns[column].shares[component];
    }
  }
  return array;
}

py::array_t<float> ofColumns(const Lanes& lanes, float evidence::Lanes::Column::*value) {
  std::vector<float> values;
  for (const evidence::Lanes::Column& column : lanes.columns) {
    values.push_back(column.*value);
  }
  return toArray(values);
}

Lanes lanesOf(const ros1::TrainedModel& trained, const std::shared_ptr<evidence::Model>& model,
              const core::Detector::Parameters& parameters, const py::object& recording,
              std::vector<std::int64_t> starts, const std::vector<core::Acceptance>& accepted) {
  RecordingEvents arrays(recording);
  arrays.missing.clear();  // neither is evidence
  arrays.senders.clear();
  evidence::Lanes lanes(model, std::move(starts));
  core::Detector detector(
      evidence::makeJudge(model, trained.limits(), trained.window,
                          std::make_shared<core::SourceGraph>(trained.graph),
                          std::make_shared<core::Vocabulary>(arrays.event_types),
                          [&](const core::Window& window, const evidence::Shares& shares) {
                            lanes.add(window, shares);
                          }),
      trained.window, parameters, [](const core::Verdict&) {});
  detector.accept(acceptancesOf(accepted));
  judgeRecording(detector, arrays);
  return {model->components(), lanes.columns()};
}

}  // namespace

void bindLanes(py::module& m) {
  py::class_<Lanes>(m, "EvidenceLanes",
                    "What a recording says of each component, by stretch of time; in units of\n"
                    "the limits: 1 is the limit.")
      .def_readonly("components", &Lanes::components,
                    "sources, or topics where the sources are not known")
      .def_property_readonly("shares", &sharesOf,
                             "the largest share of its limit, float32 [components, stretches]")
      .def_property_readonly(
          "strongest",
          [](const Lanes& self) {
            return ofColumns(self, &evidence::Lanes::Column::strongest_share);
          },
          "the largest share of all tracks, float32 [stretches]")
      .def_property_readonly(
          "tracks",
          [](const Lanes& self) {
            std::vector<std::optional<std::size_t>> tracks;
            for (const evidence::Lanes::Column& column : self.columns) {
              tracks.push_back(column.track);
            }
            return tracks;
          },
          "index of the track with the largest share, by stretch; None: there is no evidence");
  m.def("evidence_lanes", &lanesOf, py::arg("trained"), py::arg("model"), py::arg("parameters"),
        py::arg("recording"), py::arg("starts"),
        py::arg("accepted") = std::vector<core::Acceptance>(),
        "EvidenceLanes of a recording, judged as by judge_by_evidence. starts: of the stretches\n"
        "[ns], in order; ValueError if they are not.");
}

}  // namespace self_awareness::python
