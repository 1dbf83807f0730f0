#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
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
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/verdict/acceptance.h"
#include "self_awareness/core/verdict/alarm.h"
#include "self_awareness/core/verdict/incident.h"
#include "self_awareness/core/verdict/sentence.h"
#include "self_awareness/ros/ros_time.h"

namespace self_awareness::python {
namespace {

std::string sentenceOf(const std::string& kind, std::vector<std::string> components,
                       std::string topic, std::string wrong, bool is_silence, std::string begin,
                       std::string back, std::string reason, std::string end, std::string goes_on,
                       std::size_t times, std::vector<std::string> hosts, std::size_t silent) {
  return core::sentence({kindNamed(kind), std::move(components), std::move(topic),
                         std::move(wrong), std::move(reason), is_silence, std::move(begin),
                         std::move(end), std::move(goes_on), std::move(back), times,
                         std::move(hosts), silent});
}

/// A component, whether it alone would be abnormal, since when it was silent [ns], what is wrong
/// with it, and since when [ns].
using NamedState =
    std::tuple<std::string, bool, std::optional<std::int64_t>, std::string, std::int64_t>;

core::Occurrence occurrenceOf(std::uint64_t id, bool is_alarm, std::int64_t begin,
                              std::int64_t end, const std::string& kind, std::string culprit,
                              const std::vector<NamedState>& named,
                              std::vector<std::string> hosts) {
  core::Occurrence occurrence;
  occurrence.id = id;
  occurrence.level = is_alarm ? core::Alarm::Level::kAlarm : core::Alarm::Level::kSuspicion;
  occurrence.begin = begin;
  occurrence.end = end;
  occurrence.over = true;
  occurrence.kind = kindNamed(kind);
  occurrence.culprit = std::move(culprit);
  occurrence.hosts = std::move(hosts);
  for (const auto& [component, abnormal, silent_since, wrong, onset] : named) {
    occurrence.named.push_back(
        {component, abnormal, begin, silent_since, kindNamed(wrong), onset});
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

void bindAlarms(py::module& m) {
  using core::Reason;
  py::class_<Reason>(m, "Reason", "Why an event type is a suspect.")
      .def_property_readonly(
          "kind", [](const Reason& self) { return core::toString(self.kind); },
          "silent, topic silent, unanswered, slow, fast, late, early, out of order, never came ..."
          "as SelfAwareness.msg has them")
      .def_readonly("after", &Reason::after,
                    "the event type that it should come after; empty: its own last")
      .def_readonly("unit", &Reason::unit,
                    "of the four values: s, Hz, events, requests or score; a channel may have\n"
                    "others")
      .def_readonly("value", &Reason::value,
                    "what was seen: a silence, a median delay, a rate, a number")
      .def_readonly("usual", &Reason::usual, "what is to be expected of it; NaN: not known")
      .def_readonly("usual_shortest", &Reason::usual_shortest,
                    "lower end of what is usual; NaN: not known")
      .def_readonly("usual_longest", &Reason::usual_longest, "its upper end; NaN: not known")
      .def_readonly("lasted", &Reason::lasted,
                    "the value is of the last so many seconds; NaN: of one moment")
      .def_readonly("topics", &Reason::topics,
                    "that it does not subscribe to; of a stranger, what it has from others, or "
                    "plays on")
      .def_readonly("words", &Reason::words, "all of it in words and numbers")
      .def("shortly", &core::shortly, py::arg("is_silence"), py::arg("is_back"),
           "What somebody does wrong, in a few words.");

  using core::Suspect;
  py::class_<Suspect>(m, "Suspect", "An event type that may have made a window abnormal.")
      .def_readonly("id", &Suspect::id, "of the event type")
      .def_readonly("component", &Suspect::component, "whose event type it is; empty: not known")
      .def_readonly("abnormal", &Suspect::abnormal, "it alone would be abnormal")
      .def_readonly("topic", &Suspect::topic, "of its event type")
      .def_readonly("value", &Suspect::value,
                    "that its messages have: status.status=4; empty: none")
      .def_readonly("onset", &Suspect::onset,
                    "since when what is wrong with it has been so [ns]; 0: not known")
      .def_readonly("since", &Suspect::since,
                    "when the alarm or the suspicion first named its component [ns]")
      .def_readonly("reason", &Suspect::reason);

  using core::Silent;
  py::class_<Silent>(m, "Silent", "Components that fell silent together.")
      .def_readonly("hosts", &Silent::hosts, "their computers; empty: nobody was heard any more")
      .def_readonly("components", &Silent::components)
      .def_readonly("others_go_on", &Silent::others_go_on,
                    "others are heard: they stopped for another reason than a computer")
      .def_readonly("since", &Silent::since, "stamp of the last event of them [ns]")
      .def("__str__", [](const Silent& self) { return core::describe(self); });

  using core::Alarm;
  py::class_<Alarm>(m, "Alarm", "A stretch of time in which the alarm stood, or a suspicion.")
      .def_readonly("id", &Alarm::id, "unique in a recording; the monitor says the same")
      .def_property_readonly(
          "level",
          [](const Alarm& self) { return self.level == Alarm::Level::kAlarm ? "ERROR" : "WARN"; },
          "ERROR: an alarm; WARN: a suspicion")
      .def_readonly("begin", &Alarm::begin, "[ns]")
      .def_readonly("end", &Alarm::end, "[ns]")
      .def_readonly("over", &Alarm::over, "False: it stood until the end of the recording")
      .def_property_readonly(
          "kind", [](const Alarm& self) { return core::toString(self.kind); },
          "of the culprit's reason, or: busy machine, all silent, new mode, two senders,\n"
          "slower clock")
      .def_readonly("culprit", &Alarm::culprit,
                    "component; empty: there is none, or nobody stands out")
      .def_readonly("reason", &Alarm::reason,
                    "why the culprit is one, in words; without one, who is silent, or empty")
      .def_property_readonly("is_told_once", &Alarm::isToldOnce,
                             "whether it tells of what is new once, however long that lasts")
      .def_readonly("waiting", &Alarm::waiting,
                    "who waits for the culprit, who for them, and so on; empty: not known")
      .def_readonly("evidence", &Alarm::evidence,
                    "what raised it, in words; empty: a suspicion that an alarm left")
      .def_readonly("lowest_score", &Alarm::lowest_score)
      .def_property_readonly(
          "busy",
          [](const Alarm& self) {
            return self.busy ? std::optional<std::string>(core::describe(*self.busy))
                             : std::nullopt;
          },
          "in words, if the machine was too busy; None: it was not")
      .def_property_readonly("silent", copyOf<Alarm>(&Alarm::silent),
                             "who fell silent together, of what stood longest; None: nobody")
      .def_readonly("suspects", &Alarm::suspects, "of the window that raised it, best first")
      .def_readonly("later", &Alarm::later,
                    "of components that it named later, each with its time (since)")
      .def("__str__", [](const Alarm& self) { return core::sentence(self); });
  m.def("sentence", &sentenceOf, py::arg("kind"), py::arg("components"), py::arg("topic"),
        py::arg("wrong"), py::arg("is_silence"), py::arg("begin"), py::arg("back"),
        py::arg("reason") = "", py::arg("end") = "", py::arg("goes_on") = "", py::arg("times") = 1,
        py::arg("hosts") = std::vector<std::string>(), py::arg("silent") = 0,
        "Return what happened in a sentence without its full stop; times are in words.\n\n"
        "Args:\n"
        "    kind: what is wrong, as Alarm.kind.\n"
        "    components: to blame: the culprit, and who failed at once with it.\n"
        "    topic: what of the culprit is wrong, if it is alone; empty: all of it.\n"
        "    wrong: what it does wrong, as Reason.shortly() says.\n"
        "    reason: the same where nobody is to blame, or it should not be there.\n"
        "    is_silence: nothing came meanwhile: then begin is the last message.\n"
        "    begin: empty: the start.\n"
        "    end: empty: it goes on.\n"
        "    goes_on: then: until when; empty: nobody knows.\n"
        "    back: who came back when; empty: nobody did.\n"
        "    times: alarms; above 1, the times are those of the longest.\n"
        "    hosts: computers that fell silent as a whole.\n"
        "    silent: components that did.\n");
}

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
