#include <pybind11/stl.h>

#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

#include "bindings.h"
#include "self_awareness/core/evidence/limits/drift.h"
#include "self_awareness/core/evidence/limits/drift_samples.h"

namespace self_awareness::python {

using core::evidence::Drift;
using core::evidence::DriftSamples;
using StretchState = std::tuple<std::int64_t, std::int64_t, std::int64_t, std::vector<double>>;

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
                    "alarms over a lifetime are bounded (docs/learn.md).")
      .def("component", &Drift::component, py::arg("number"))
      .def_property_readonly("samples", &Drift::samples, "number of samples so far")
      .def_property_readonly("needed", &Drift::needed, "evidence from which on it is told");
  m.def(
      "drift_of",
      [](std::size_t components, const std::vector<StretchState>& normal) {
        DriftSamples samples(components);
        for (const auto& [begin, end, robot_start, shares] : normal) {
          samples.add({begin, end, robot_start, shares});
        }
        return samples.drift();
      },
      py::arg("components"), py::arg("normal"),
      "The Drift that times say which were normal, in their order: of each (begin [ns], end\n"
      "[ns], robot_start, shares). robot_start: the same for all of a start of the robot; 0: not\n"
      "known, then a start ends with a pause of more than a minute. shares: the largest share of\n"
      "its limit, of each component. A sample is all of a start of the robot, or of a day of\n"
      "one. ValueError if the number of shares is another one, or one is not finite or below 0.");
}

}  // namespace self_awareness::python
