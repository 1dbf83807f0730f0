#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "bindings.h"
#include "self_awareness/core/learn.h"
#include "self_awareness/ros/model/model_file.h"

namespace self_awareness::python {
namespace {

namespace evidence = core::evidence;

using Findings = evidence::LimitFinder::Findings;
using PartState = std::tuple<std::uint64_t, std::vector<float>, std::vector<std::int64_t>>;
using RecordingState = std::tuple<std::int64_t, std::int64_t, std::int64_t, bool, std::uint64_t,
                                  std::vector<PartState>, std::vector<std::uint8_t>,
                                  std::vector<std::int64_t>, std::string>;
using FindingsState = std::vector<RecordingState>;

FindingsState stateOf(const Findings& findings) {
  FindingsState state;
  for (const evidence::LimitFinder::Recording& recording : findings) {
    std::vector<PartState> parts;
    for (const auto& [windows, evidence, gaps] : recording.parts) {
      parts.emplace_back(windows, evidence, gaps);
    }
    std::vector<std::uint8_t> said;
    for (const evidence::Said each : recording.said) {
      said.push_back(static_cast<std::uint8_t>(each));
    }
    state.emplace_back(recording.start, recording.end, recording.robot_start, recording.trained_on,
                       recording.windows, parts, said, recording.firsts, recording.robot);
  }
  return state;
}

Findings fromState(const FindingsState& state) {
  Findings findings;
  for (const auto& [start, end, robot_start, trained_on, windows, parts, said, firsts, robot] :
       state) {
    evidence::LimitFinder::Recording& recording = findings.emplace_back();
    recording.start = start;
    recording.end = end;
    recording.robot_start = robot_start;
    recording.trained_on = trained_on;
    recording.windows = windows;
    recording.firsts = firsts;
    recording.robot = robot;
    for (const auto& [part_windows, evidence, gaps] : parts) {
      recording.parts.push_back({part_windows, evidence, gaps});
    }
    for (const std::uint8_t each : said) {
      recording.said.push_back(static_cast<evidence::Said>(each));
    }
  }
  return findings;
}

core::Recording recordingOf(const Stamps& stamps, const Ids& ids, std::int64_t robot_start,
                            std::vector<std::int64_t> clock_steps, std::string robot,
                            const MessageAttributes& attributes,
                            std::vector<core::Waiting> waiting = {}) {
  core::Recording recording;
  recording.events.reserve(static_cast<std::size_t>(stamps.size()));
  forEachEvent(stamps, ids, attributes,
               [&](const core::Event& event) { recording.events.push_back(event); });
  recording.robot_start = robot_start;
  recording.clock_steps = core::ClockSteps(std::move(clock_steps));
  recording.robot = std::move(robot);
  recording.waiting = std::move(waiting);
  return recording;
}

}  // namespace

void bindCalibration(py::module& m) {
  py::class_<Findings>(m, "LimitFindings",
                       "What a Calibrator learned from recordings; may go to another process.")
      .def(py::init<>(), "Of no recording.")
      .def(py::pickle([](const Findings& self) { return stateOf(self); },
                      [](const FindingsState& state) { return fromState(state); }));

  m.attr("OTHER_MODE") = core::kOtherMode;
  m.attr("HOURS_OF_ROBOTS") = evidence::LimitFinder::kHoursOfRobots;

  using core::Calibrator;
  py::class_<Calibrator>(m, "Calibrator",
                         "Finds the limits of a model by recordings of normal operation.\n"
                         "Other calibrators, in other processes, may judge some of them; merge() "
                         "adds their findings.")
      .def(py::init([](const ros1::TrainedModel& trained, std::int64_t settle_time) {
             return std::make_unique<Calibrator>(trained, Calibrator::Parameters{settle_time});
           }),
           py::arg("trained"), py::arg("settle_time"), "settle_time: [ns]")
      .def(
          "add_trained_on",
          [](Calibrator& self, const Stamps& stamps, const Ids& ids, std::uint64_t fingerprint,
             std::int64_t robot_start, std::vector<std::int64_t> clock_steps, std::string robot,
             const MessageAttributes& attributes, std::vector<core::Waiting> waiting) {
            core::Recording recording =
                recordingOf(stamps, ids, robot_start, std::move(clock_steps), std::move(robot),
                            attributes, std::move(waiting));
            recording.fingerprint = fingerprint;
            const py::gil_scoped_release release;
            self.addTrainedOn(recording);
          },
          py::arg("stamps"), py::arg("ids"), py::arg("fingerprint"), py::arg("robot_start") = 0,
          py::arg("clock_steps") = std::vector<std::int64_t>(), py::arg("robot") = "",
          py::arg("attributes") = py::none(), py::arg("waiting") = std::vector<core::Waiting>(),
          "Takes in a recording of the training: it is judged by what the other half says.\n"
          "fingerprint: that the training knows it by; robot_start: of the robot [ns], 0: not\n"
          "known; clock_steps: with which the clock was set forward (find_clock_steps); robot:\n"
          "its name, empty: not known; attributes: of the messages\n"
          "(RecordedEvents.attributes), None: not known; waiting: how the machine was, in the\n"
          "order of time (RecordedEvents.waiting), empty: not known.")
      .def(
          "add_held_out",
          [](Calibrator& self, const Stamps& stamps, const Ids& ids, std::int64_t robot_start,
             std::vector<std::int64_t> clock_steps, std::string robot,
             const MessageAttributes& attributes, std::vector<core::Waiting> waiting) {
            const core::Recording recording =
                recordingOf(stamps, ids, robot_start, std::move(clock_steps), std::move(robot),
                            attributes, std::move(waiting));
            const py::gil_scoped_release release;
            self.addHeldOut(recording);
          },
          py::arg("stamps"), py::arg("ids"), py::arg("robot_start") = 0,
          py::arg("clock_steps") = std::vector<std::int64_t>(), py::arg("robot") = "",
          py::arg("attributes") = py::none(), py::arg("waiting") = std::vector<core::Waiting>(),
          "Takes in a recording that was not trained on.\n"
          "The id OTHER_MODE tells a mode that the model does not know.")
      .def("part", &Calibrator::part, "A calibrator without findings, for the same model.")
      .def("findings", &Calibrator::findings, "LimitFindings of what was added.")
      .def("merge", &Calibrator::merge, py::arg("findings"))
      .def(
          "find",
          [](const Calibrator& self, double budget) {
            core::Calibration calibration = self.find(budget);
            calibration.stamp = now();
            return calibration;
          },
          py::arg("budget"),
          "Calibration, without its recordings; ValueError if the recordings were too short.\n"
          "budget: false alarms an hour that its limits allow");

  using core::Learner;
  py::class_<Learner>(m, "Learner", "Learns from recordings in memory, one after the other.")
      .def(py::init([](const core::evidence::Tuning& tuning, const std::set<EdgeState>& graph,
                       std::int64_t window) {
             Learner::Parameters parameters;
             parameters.counting.window = window;
             parameters.tuning = tuning;
             return std::make_unique<Learner>(parameters, graphOf(graph));
           }),
           py::arg("tuning") = core::evidence::Tuning{}, py::arg("graph") = std::set<EdgeState>{},
           py::arg("window") = core::kDefaultWindow, "graph: as of TrainedModel; window: [ns]")
      .def(
          "add",
          [](Learner& self, const std::vector<core::EventType>& types, const Stamps& stamps,
             const Ids& ids, std::uint64_t fingerprint, std::int64_t robot_start,
             std::vector<std::int64_t> clock_steps, std::string robot,
             const MessageAttributes& attributes) {
            core::Recording recording = recordingOf(
                stamps, ids, robot_start, std::move(clock_steps), std::move(robot), attributes);
            recording.fingerprint = fingerprint;
            for (core::Event& event : recording.events) {
              event.id = self.intern(types.at(event.id));
            }
            self.add(std::move(recording));
          },
          py::arg("event_types"), py::arg("stamps"), py::arg("ids"), py::arg("fingerprint"),
          py::arg("robot_start") = 0, py::arg("clock_steps") = std::vector<std::int64_t>(),
          py::arg("robot") = "", py::arg("attributes") = py::none(),
          "Learns from a recording given as arrays; ids are indices of event_types.")
      .def(
          "learn",
          [](Learner& self) {
            ros1::TrainedModel model(self.learn());
            model.stamp = now();
            return model;
          },
          "Ends the learning: a TrainedModel, with limits if there was enough to find them.")
      .def_property_readonly("why", &Learner::why,
                             "why it found no limits; empty: it has found some");
}

}  // namespace self_awareness::python
