#include <pybind11/stl.h>

#include <limits>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bindings.h"
#include "ros/verdict/kept_files.h"
#include "self_awareness/SelfAwareness.h"
#include "self_awareness/core/verdict/incident.h"
#include "self_awareness/ros/ros_time.h"

namespace self_awareness::python {
namespace {

/// A component, whether it alone would be abnormal, since when it was silent [ns], what is wrong
/// with it, and since when [ns].
using NamedState =
    std::tuple<std::string, bool, std::optional<std::int64_t>, std::string, std::int64_t>;

core::Occurrence occurrenceOf(std::uint64_t id, bool is_alarm, std::int64_t begin,
                              std::int64_t end, const std::string& kind, std::string culprit,
                              std::vector<NamedState> named, std::vector<std::string> hosts) {
  core::Occurrence occurrence;
  occurrence.id = id;
  occurrence.level = is_alarm ? core::Alarm::Level::kAlarm : core::Alarm::Level::kSuspicion;
  occurrence.begin = begin;
  occurrence.end = end;
  occurrence.over = true;
  occurrence.kind = kindNamed(kind);
  occurrence.culprit = std::move(culprit);
  occurrence.hosts = std::move(hosts);
  for (auto& [component, abnormal, silent_since, wrong, onset] : named) {
    occurrence.named.push_back(
        {std::move(component), abnormal, begin, silent_since, kindNamed(wrong), onset});
  }
  return occurrence;
}

std::vector<core::Incident> fold(const std::vector<core::Occurrence>& occurrences,
                                 const std::set<EdgeState>& edges) {
  const core::SourceGraph graph = graphOf(edges);
  core::Incidents incidents(std::numeric_limits<std::int64_t>::max(), occurrences.size());
  for (const core::Occurrence& occurrence : occurrences) {
    incidents.add(occurrence, graph);
  }
  return incidents.list(graph);
}

using Kept = self_awareness::Incident;

std::optional<std::vector<Kept>> readKept(const std::string& path) {
  std::optional<self_awareness::Incidents> incidents = ros1::readIncidents(path);
  return incidents ? std::optional(std::move(incidents->incidents)) : std::nullopt;
}

/// The getter of a time [ns].
auto stampOf(ros::Time Kept::*member) {
  return [member](const Kept& self) { return ros1::fromRosTime(self.*member); };
}

void bindKept(py::module& m) {
  py::class_<Kept>(m, "KeptIncident", "An incident in the file of a monitor: msg/Incident.msg.")
      .def_readonly("id", &Kept::id, "of its first alarm, or else of its first suspicion")
      .def_property_readonly(
          "level",
          [](const Kept& self) {
            return self.level == self_awareness::SelfAwareness::ERROR ? "ERROR" : "WARN";
          },
          "ERROR: there were alarms; WARN: near misses only")
      .def_readonly("kind", &Kept::kind, "as Alarm.kind")
      .def_readonly("component", &Kept::component, "that is to blame; empty: none")
      .def_readonly("reason", &Kept::reason, "in words")
      .def_readonly("together", &Kept::together, "as Incident.together")
      .def_readonly("victims", &Kept::victims, "as Incident.victims")
      .def_readonly("others", &Kept::others, "as Incident.others")
      .def_readonly("hosts", &Kept::hosts, "computers that fell silent as a whole")
      .def_property_readonly("opened", stampOf(&Kept::opened), "[ns]")
      .def_property_readonly("grown", stampOf(&Kept::grown), "[ns]")
      .def_property_readonly("ended", stampOf(&Kept::ended), "[ns]; so far if it is open")
      .def_property_readonly("over", [](const Kept& self) { return self.over != 0U; })
      .def_property_readonly(
          "unknown", [](const Kept& self) { return self.unknown != 0U; },
          "over, as its monitor ended while it was open")
      .def_readonly("alarms", &Kept::alarms, "how often it was raised")
      .def_readonly("near_misses", &Kept::near_misses,
                    "how often it was suspected, and no alarm followed")
      .def_readonly("recording", &Kept::recording,
                    "path of the flight recorder's file; empty: there is none")
      .def_readonly("model", &Kept::model, "path of the model that judged");
  m.def("read_incidents", &readKept, py::arg("path"),
        "The KeptIncidents of a monitor's file, the oldest first; None: there is no file.\n"
        "BagError if it is damaged, or another file.");
}

}  // namespace

void bindIncidents(py::module& m) {
  using core::Incident;
  py::class_<core::Occurrence>(
      m, "Occurrence", "An alarm or a suspicion of a recording, as incidents are made of them.")
      .def(py::init(&occurrenceOf), py::arg("id"), py::arg("is_alarm"), py::arg("begin"),
           py::arg("end"), py::arg("kind"), py::arg("culprit"), py::arg("named"), py::arg("hosts"),
           "Times in ns; named: of each suspect the component, whether it alone would be\n"
           "abnormal, since when it was silent (None: it was not), and whether training never\n"
           "heard it; hosts: computers that fell silent as a whole. ValueError: there is no such\n"
           "kind.");
  py::class_<Incident>(m, "Incident", "All that one cause has done.")
      .def_readonly("main", &Incident::main,
                    "id of the longest one that blames the cause, alarms first")
      .def_readonly("ids", &Incident::ids, "of its alarms and suspicions, in the order of time")
      .def_readonly("cause", &Incident::cause, "component; empty: nobody is to blame")
      .def_readonly("together", &Incident::together,
                    "failed at once with it, and do not need its messages")
      .def_readonly("victims", &Incident::victims,
                    "are named, and need messages of these; none, if there is no graph")
      .def_readonly("others", &Incident::others, "are named besides");
  m.def("fold_incidents", &fold, py::arg("occurrences"), py::arg("graph"),
        "The Incidents of a recording, in the order in which they were opened.\n"
        "occurrences: in the order of time; graph: as TrainedModel.graph");
  bindKept(m);
}

}  // namespace self_awareness::python
