#include <pybind11/stl.h>

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "bindings.h"
#include "self_awareness/core/evidence/limits/drift.h"
#include "self_awareness/core/evidence/limits/drift_samples.h"

namespace self_awareness::python {

using core::evidence::Drift;
using core::evidence::DriftSamples;

void bindDrift(py::module& m) {
  py::class_<Drift::Component>(m, "ComponentDrift", "How far a component has drifted.")
      .def_readonly("evidence", &Drift::Component::evidence, "of the test; 1 at the beginning")
      .def_readonly("usual", &Drift::Component::usual,
                    "median of its largest shares; 1 is the limit")
      .def_readonly("last", &Drift::Component::last, "share of the last sample")
      .def_readonly("told_by", &Drift::Component::told_by,
                    "number of the sample, from 1, that told it first; 0: none did");
  py::class_<Drift>(m, "Drift",
                    "Tells that what is heard drifts towards the limits: a test whose false\n"
                    "alarms over a lifetime are bounded (docs/learn_more.md).")
      .def("component", &Drift::component, py::arg("number"))
      .def_property_readonly("samples", &Drift::samples, "number of samples so far")
      .def_property_readonly("needed", &Drift::needed, "evidence from which on it is told");
  py::class_<DriftSamples>(m, "DriftSamples",
                           "What is one sample of a Drift: all that was normal in a start of the\n"
                           "robot, or in a day of one.")
      .def(py::init<std::size_t>(), py::arg("components"))
      .def(
          "add",
          [](DriftSamples& self, std::int64_t begin, std::int64_t end, std::int64_t robot_start,
             std::vector<double> shares) {
            self.add({begin, end, robot_start, std::move(shares)});
          },
          py::arg("begin"), py::arg("end"), py::arg("robot_start"), py::arg("shares"),
          "Takes in the next time that was normal [ns]. robot_start: the same for all of a start\n"
          "of the robot; 0: not known, then a start ends with a pause of more than a minute.\n"
          "shares: the largest share of its limit, of each component; ValueError if their number "
          "is\n"
          "another one, or one is not finite or below 0.")
      .def_property_readonly("drift", &DriftSamples::drift, "what they say");
}

}  // namespace self_awareness::python
