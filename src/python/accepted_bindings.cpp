#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "ros/verdict/kept_files.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/verdict/acceptance.h"

namespace self_awareness::python {
namespace {

using core::Acceptance;

Acceptance acceptanceOf(std::string component, std::string topic, const std::string& kind,
                        std::int64_t at, std::string by, std::vector<std::string> together) {
  Acceptance acceptance;
  acceptance.component = std::move(component);
  acceptance.topic = std::move(topic);
  acceptance.kind = kind.empty() ? std::nullopt : std::optional(kindNamed(kind));
  acceptance.at = at;
  acceptance.by = std::move(by);
  acceptance.together = std::move(together);
  std::sort(acceptance.together.begin(), acceptance.together.end());
  if ((acceptance.kind == core::Kind::kNewMode) == acceptance.together.empty()) {
    throw std::invalid_argument(
        "those who are off together are of the kind new mode, and of no "
        "other");
  }
  return acceptance;
}

std::optional<std::vector<Acceptance>> read(const std::string& path) {
  const std::optional<core::Acceptances> accepted = ros1::readAccepted(path);
  return accepted ? std::optional(accepted->list()) : std::nullopt;
}

}  // namespace

core::Acceptances acceptancesOf(const std::vector<Acceptance>& list) {
  core::Acceptances accepted;
  for (const Acceptance& each : list) {
    if (!accepted.add(each)) {
      throw std::invalid_argument("more than " + std::to_string(core::Acceptances::kMost) +
                                  " are accepted");
    }
  }
  return accepted;
}

void bindAccepted(py::module& m) {
  py::class_<Acceptance>(m, "Acceptance",
                         "What somebody takes as normal from now on (docs/live.md).")
      .def(py::init(&acceptanceOf), py::arg("component") = "", py::arg("topic") = "",
           py::arg("kind") = "", py::arg("at") = 0, py::arg("by") = "",
           py::arg("together") = std::vector<std::string>(),
           "component, topic: a name, or its begin and a *; empty: all. kind: as Alarm.kind;\n"
           "empty: all that it does. at: [ns]. together: of the kind new mode, the components\n"
           "that are off. ValueError: there is no such kind, or no such mode.")
      .def_readonly("component", &Acceptance::component)
      .def_readonly("topic", &Acceptance::topic)
      .def_property_readonly("kind",
                             [](const Acceptance& self) {
                               return self.kind ? core::toString(*self.kind) : std::string();
                             })
      .def_readonly("at", &Acceptance::at, "when it was accepted [ns]")
      .def_readonly("by", &Acceptance::by, "node that asked for it")
      .def_readonly("together", &Acceptance::together,
                    "of the kind new mode: components that are off together, in order")
      .def(
          "is_about",
          [](const Acceptance& self, const core::EventType& type) {
            return self.isAbout(core::componentOf(type.source, type.scope), type.scope);
          },
          py::arg("event_type"))
      .def("__eq__", [](const Acceptance& self, const Acceptance& other) {
        return self.isLike(other) && self.at == other.at && self.by == other.by;
      });
  m.def("read_accepted", &read, py::arg("path"),
        "The Acceptances of a file beside a model; None: there is no file.\n"
        "BagError if it is damaged, or another file.");
  m.def(
      "write_accepted",
      [](const std::vector<Acceptance>& accepted, const std::string& path) {
        ros1::writeAccepted(acceptancesOf(accepted), path);
      },
      py::arg("accepted"), py::arg("path"),
      "Writes the file, whole or not at all. FileError or BagError if it cannot be written.");
}

}  // namespace self_awareness::python
