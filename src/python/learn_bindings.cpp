#include <pybind11/stl.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "ros/model/bytes.h"
#include "ros/model/model_fields.h"
#include "self_awareness/core/learn.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/file_version.h"
#include "self_awareness/ros/model/model_file.h"

namespace self_awareness::python {
namespace {

namespace evidence = core::evidence;

using Findings = evidence::LimitFinder::Findings;

/// What is pickled: the bytes of a model file, and what that has no need of.
py::bytes stateOf(const Findings& findings) {
  std::vector<std::vector<std::int64_t>> firsts;
  std::vector<std::uint8_t> trained_on;
  for (const evidence::LimitFinder::Recording& recording : findings) {
    firsts.push_back(recording.firsts);
    trained_on.push_back(recording.trained_on ? 1 : 0);
  }
  ros1::ByteWriter bytes;
  bytes(findings, firsts, trained_on);
  const std::vector<std::uint8_t> taken = bytes.take();
  return {reinterpret_cast<const char*>(taken.data()), taken.size()};
}

Findings fromState(const py::bytes& state) {
  const auto text = static_cast<std::string>(state);
  ros1::ByteReader bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size(),
                         ros1::kModelFile.format);
  Findings findings;
  std::vector<std::vector<std::int64_t>> firsts;
  std::vector<std::uint8_t> trained_on;
  bytes(findings, firsts, trained_on);
  for (std::size_t k = 0; k < findings.size(); ++k) {
    findings[k].firsts = firsts.at(k);
    findings[k].trained_on = trained_on.at(k) != 0;
  }
  return findings;
}

/// A recording of ids of a model.
core::Recording recordingOf(const Stamps& stamps, const Ids& ids,
                            std::optional<std::uint64_t> fingerprint, std::int64_t robot_start,
                            std::vector<std::int64_t> clock_steps, std::string robot,
                            const MessageAttributes& attributes) {
  core::Recording recording;
  recording.events.reserve(static_cast<std::size_t>(stamps.size()));
  forEachEvent(stamps, ids, attributes,
               [&](const core::Event& event) { recording.events.push_back(event); });
  recording.fingerprint = fingerprint;
  recording.robot_start = robot_start;
  recording.robot = std::move(robot);
  recording.clock_steps = core::ClockSteps(std::move(clock_steps));
  return recording;
}

/// A learner, and how messages became its events.
class Learner : public core::Learner {
 public:
  using Before = std::optional<std::pair<Stamps, Ids>>;

  Learner(const Parameters& parameters, core::SourceGraph graph, ros1::EncodingRules rules)
      : core::Learner(parameters, std::move(graph)), rules_(std::move(rules)) {}

  /// Gives the events of a recording the ids of the learner.
  void intern(const std::vector<core::EventType>& types, const Before& before,
              core::Recording& recording) {
    if (before) {
      for (const core::EventType& type : types) {
        intern(type);  // first, so that ids are in the order of the part
      }
      if (before->first.size() > 0) {
        recording.since = before->first.at(0);
      }
      forEachEvent(before->first, before->second, [&](const core::Event& event) {
        if (event.id < types.size()) {
          recording.before.push_back({event.stamp, intern(types[event.id])});
        }
      });
    }
    std::vector<std::optional<core::EventId>> here(types.size());
    for (core::Event& event : recording.events) {
      std::optional<core::EventId>& id = here.at(event.id);
      if (!id) {
        id = intern(types[event.id]);
      }
      event.id = *id;
    }
  }

  ros1::TrainedModel counted(bool watch) {
    ros1::TrainedModel model = trained(counts());
    if (watch) {
      model.watch();
    }
    return model;
  }
  ros1::TrainedModel learned() { return trained(learn()); }

 private:
  core::EventId intern(const core::EventType& type) {
    const std::size_t before = vocabulary().size();
    const core::EventId id = core::Learner::intern(type);
    if (vocabulary().size() > before) {
      ros1::checkEventTypes(rules_, vocabulary());
    }
    return id;
  }

  ros1::TrainedModel trained(core::Model counted) const {
    ros1::TrainedModel model(std::move(counted));
    model.encoding = rules_;
    model.stamp = now();
    return model;
  }

  ros1::EncodingRules rules_;
};

/// Binds what takes in a recording given as arrays.
/// @param learn count() or add()
template <typename Learn>
void bindRecording(py::class_<Learner>& learner, const char* name, const char* words,
                   Learn learn) {
  learner.def(
      name,
      [learn](Learner& self, const std::vector<core::EventType>& types, const Stamps& stamps,
              const Ids& ids, std::uint64_t fingerprint, std::int64_t robot_start,
              std::vector<std::int64_t> clock_steps, std::string robot,
              const MessageAttributes& attributes, std::string bag,
              const Learner::Before& before) {
        core::Recording recording =
            recordingOf(stamps, ids, fingerprint, robot_start, std::move(clock_steps),
                        std::move(robot), attributes);
        recording.name = std::move(bag);
        self.intern(types, before, recording);
        const py::gil_scoped_release release;
        (self.*learn)(std::move(recording));
      },
      py::arg("event_types"), py::arg("stamps"), py::arg("ids"), py::arg("fingerprint") = 0,
      py::arg("robot_start") = 0, py::arg("clock_steps") = std::vector<std::int64_t>(),
      py::arg("robot") = "", py::arg("attributes") = py::none(), py::arg("bag") = "",
      py::arg("before") = py::none(), words);
}

void bindLearner(py::module& m) {
  m.def("half_of", &core::evidence::halfOf, py::arg("fingerprint"),
        "The half of a training that a recording belongs to, 0 or 1.");
  py::class_<Learner> learner(m, "Learner", "Learns from one recording after the other.");
  learner
      .def(py::init([](const core::evidence::Tuning& tuning, const std::set<EdgeState>& graph,
                       std::int64_t window, ros1::EncodingRules encoding, std::int64_t bin_size,
                       std::int64_t horizon_bins, bool evidence, bool paper) {
             const Learner::Counting counting{evidence, paper, window, {bin_size, horizon_bins}};
             return std::make_unique<Learner>(Learner::Parameters{counting, {}, tuning},
                                              graphOf(graph), std::move(encoding));
           }),
           py::arg("tuning") = core::evidence::Tuning{}, py::arg("graph") = std::set<EdgeState>{},
           py::arg("window") = core::kDefaultWindow, py::arg("encoding") = ros1::EncodingRules{},
           py::arg("bin_size") = core::paper::Binning{}.bin_size, py::arg("horizon_bins") = 0,
           py::arg("evidence") = true, py::arg("paper") = false,
           "tuning: the numbers of the evidence detector; graph: as of TrainedModel; window,\n"
           "bin_size: [ns]; horizon_bins 0: unbounded; evidence, paper: the detectors that it is\n"
           "for")
      .def("model", &Learner::counted, py::arg("watch") = true,
           "Ends the learning: a TrainedModel of all that was counted, without limits. watch:\n"
           "choose what is watched; not needed for a model that is merged into another.")
      .def("learn", &Learner::learned,
           "Ends the learning: a TrainedModel, with limits if there was enough to find them in\n"
           "the recordings of add().")
      .def_property_readonly("why", &Learner::why,
                             "why learn() found no limits; empty: it has found some");
  bindRecording(learner, "count",
                "Counts a recording given as arrays; ids are indices of event_types.\n"
                "fingerprint: says which half of the training it belongs to (half_of);\n"
                "robot_start: of the robot [ns], 0: not known; clock_steps: with which the clock\n"
                "was set forward (find_clock_steps); robot: its name, empty: not known;\n"
                "attributes: of the messages (RecordedEvents.attributes), None: not known; bag:\n"
                "what the model calls it; before: stamps and ids of the events of the recording\n"
                "before these, which only say when event types came first; ids from\n"
                "len(event_types) on are of no type of these.\n"
                "After a ValueError it is incomplete: do not use it any more.",
                &core::Learner::count);
  bindRecording(learner, "add", "The same, and keeps its events for the limits of learn().",
                &core::Learner::add);
}

void bindCalibrator(py::module& m) {
  py::class_<Findings>(m, "LimitFindings",
                       "What a Calibrator learned from recordings; may go to another process.")
      .def(py::init<>(), "Of no recording.")
      .def(py::pickle([](const Findings& self) { return stateOf(self); },
                      [](const py::bytes& state) { return fromState(state); }));

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
          "add",
          [](Calibrator& self, const Stamps& stamps, const Ids& ids,
             std::optional<std::uint64_t> fingerprint, std::int64_t robot_start,
             std::vector<std::int64_t> clock_steps, std::string robot,
             const MessageAttributes& attributes, std::vector<core::Waiting> waiting) {
            core::Recording recording =
                recordingOf(stamps, ids, fingerprint, robot_start, std::move(clock_steps),
                            std::move(robot), attributes);
            recording.waiting = std::move(waiting);
            const py::gil_scoped_release release;
            fingerprint ? self.addTrainedOn(recording) : self.addHeldOut(recording);
          },
          py::arg("stamps"), py::arg("ids"), py::arg("fingerprint") = py::none(),
          py::arg("robot_start") = 0, py::arg("clock_steps") = std::vector<std::int64_t>(),
          py::arg("robot") = "", py::arg("attributes") = py::none(),
          py::arg("waiting") = std::vector<core::Waiting>(),
          "Takes in a recording; ids are the model's, and OTHER_MODE tells a mode that it does\n"
          "not know. fingerprint: that the training knows it by: it is judged by what the other\n"
          "half says; None: it was not trained on. waiting: how the machine was, in the order of\n"
          "time (RecordedEvents.waiting), empty: not known. The others: as Learner.count().")
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
}

}  // namespace

void bindLearning(py::module& m) {
  bindLearner(m);
  bindCalibrator(m);
}

}  // namespace self_awareness::python
