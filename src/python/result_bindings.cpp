#include <pybind11/stl.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "ros/verdict/result_bag.h"
#include "self_awareness/ros/model/model_file.h"

namespace self_awareness::python {

void bindResults(py::module& m) {
  using ros1::ReplayedMonitor;
  using ros1::ResultBag;
  py::class_<ResultBag>(m, "ResultBag",
                        "A bag of what the monitor would have published of recordings.")
      .def(py::init<const std::string&, const std::string&>(), py::arg("path"),
           py::arg("named") = "",
           "Creates the file, or empties the one that is there. named: what errors call it, if\n"
           "not by its path. BagError where that fails.")
      .def("close", &ResultBag::close, "Completes the file. BagError where that fails.")
      .def_static("is_one", &ResultBag::isOne, py::arg("path"),
                  "Whether a file is a whole bag that this class wrote, and no recording.");

  py::class_<ReplayedMonitor>(m, "ReplayedMonitor",
                              "Writes into a result bag what the monitor would have said while a\n"
                              "recording was made; given to what judges the recording.")
      .def(py::init([](ResultBag& bag, const std::string& model_path,
                       const ros1::TrainedModel& trained, bool calibrated,
                       const std::vector<core::EventType>& event_types, std::int64_t start,
                       std::vector<core::evidence::Coverage> coverage) {
             const ReplayedMonitor::Model model{model_path, calibrated, trained.window,
                                                trained.vocabulary().size(), std::move(coverage)};
             return std::make_unique<ReplayedMonitor>(bag, model, event_types, start);
           }),
           py::arg("bag"), py::arg("model_path"), py::arg("trained"), py::arg("calibrated"),
           py::arg("event_types"), py::arg("start"),
           py::arg("coverage") = std::vector<core::evidence::Coverage>(), py::keep_alive<1, 2>(),
           "model_path: what the diagnostics call the model. calibrated: there are limits, or a\n"
           "threshold, for the detector. event_types: by id, those of the model first.\n"
           "start: of the recording [ns]. coverage: of the components; none: not known.");
}

}  // namespace self_awareness::python
