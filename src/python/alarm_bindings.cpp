#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "self_awareness/core/verdict/alarm.h"
#include "self_awareness/core/verdict/sentence.h"

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

}  // namespace self_awareness::python
