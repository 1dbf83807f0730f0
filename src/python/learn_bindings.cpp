#include <pybind11/stl.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bindings.h"
#include "ros/model/bytes.h"
#include "ros/model/model_fields.h"
#include "self_awareness/core/evidence/limits/drift.h"
#include "self_awareness/core/evidence/limits/drift_samples.h"
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

/// A recording with its events, by its own ids.
core::Recording recordingOf(const RecordingEvents& arrays) {
  core::Recording recording = arrays.recording;
  recording.events.reserve(static_cast<std::size_t>(arrays.stamps.size()));
  forEachEvent(arrays.stamps, arrays.ids, arrays.attributes,
               [&](const core::Event& event) { recording.events.push_back(event); });
  return recording;
}

/// A learner, and how messages became its events.
class Learner : public core::Learner {
 public:
  Learner(const Parameters& parameters, core::SourceGraph graph, ros1::EncodingRules rules)
      : core::Learner(parameters, std::move(graph)), rules_(std::move(rules)) {}

  void count(const py::object& from) {
    const core::Recording recording = interned(RecordingEvents(from));
    const py::gil_scoped_release release;
    core::Learner::count(recording);
  }
  void add(const py::object& from) {
    core::Recording recording = interned(RecordingEvents(from));
    const py::gil_scoped_release release;
    core::Learner::add(std::move(recording));
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
  /// A recording by the ids of the learner.
  core::Recording interned(const RecordingEvents& arrays) {
    core::Recording recording = recordingOf(arrays);
    const std::vector<core::EventType>& types = arrays.event_types;
    if (arrays.before) {
      for (const core::EventType& type : types) {
        intern(type);  // first, so that ids are in the order of the part
      }
      const auto& [stamps, ids] = *arrays.before;
      if (stamps.size() > 0) {
        recording.since = stamps.at(0);
      }
      forEachEvent(stamps, ids, {}, [&](const core::Event& event) {
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
    return recording;
  }

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

void bindLearner(py::module& m) {
  m.def("half_of", &core::evidence::halfOf, py::arg("fingerprint"),
        "The half of a training that a recording belongs to, 0 or 1.");
  py::class_<Learner>(m, "Learner", "Learns from one recording after the other.")
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
      .def("count", &Learner::count, py::arg("recording"),
           "Counts a recording (recordings.RecordingEvents). After a ValueError the learner is\n"
           "incomplete: do not use it any more.")
      .def("add", &Learner::add, py::arg("recording"),
           "The same, and keeps its events for the limits of learn().")
      .def("model", &Learner::counted, py::arg("watch") = true,
           "Ends the learning: a TrainedModel of all that was counted, without limits. watch:\n"
           "choose what is watched; not needed for a model that is merged into another.")
      .def("learn", &Learner::learned,
           "Ends the learning: a TrainedModel, with limits if there was enough to find them in\n"
           "the recordings of add().");
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
          [](Calibrator& self, const py::object& from, bool trained_on) {
            const core::Recording recording = recordingOf(RecordingEvents(from));
            const py::gil_scoped_release release;
            trained_on ? self.addTrainedOn(recording) : self.addHeldOut(recording);
          },
          py::arg("recording"), py::arg("trained_on") = false,
          "Takes in a recording (recordings.RecordingEvents); ids are the model's, OTHER_MODE\n"
          "tells a mode that it lacks. trained_on: the other half of the training judges it.")
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

void bindDrift(py::module& m) {
  using evidence::Drift;
  using StretchState = std::tuple<std::int64_t, std::int64_t, std::int64_t, std::vector<double>>;
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
        evidence::DriftSamples samples(components);
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
