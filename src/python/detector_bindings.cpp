#include <pybind11/stl.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "core/evidence/lanes.h"
#include "ros/verdict/result_bag.h"
#include "self_awareness/core/evidence/judge.h"
#include "self_awareness/core/paper/judge.h"
#include "self_awareness/core/paper/model.h"
#include "self_awareness/core/verdict/alarm.h"
#include "self_awareness/core/verdict/detector.h"
#include "self_awareness/core/verdict/persistence.h"
#include "self_awareness/core/verdict/roc.h"
#include "self_awareness/ros/model/model_file.h"

namespace self_awareness::python {
namespace {

namespace evidence = core::evidence;

/// The verdicts on all windows of a recording, one entry a window.
struct Verdicts {
  std::vector<std::int64_t> start;  // [ns]
  std::vector<std::uint32_t> events;
  std::vector<std::uint32_t> unknown;
  std::vector<double> score;  // NaN: no events
  std::vector<bool> abnormal;
  std::vector<bool> settling;
  std::vector<bool> suspicion;
  std::vector<core::Alarm> alarms;
  std::vector<core::Alarm> suspicions;
};

/// The getter of a member, as an array.
template <typename T>
auto arrayOf(std::vector<T> Verdicts::*member) {
  return [member](const Verdicts& self) { return toArray(self.*member); };
}

void record(const core::Alarm& alarm, Verdicts& verdicts) {
  (alarm.level == core::Alarm::Level::kAlarm ? verdicts.alarms : verdicts.suspicions)
      .push_back(alarm);
}

void record(const core::Verdict& verdict, Verdicts& verdicts) {
  verdicts.start.push_back(verdict.window->start);
  verdicts.events.push_back(static_cast<std::uint32_t>(verdict.window->events.size()));
  verdicts.unknown.push_back(static_cast<std::uint32_t>(verdict.window->unknown()));
  verdicts.score.push_back(verdict.score.value_or(std::numeric_limits<double>::quiet_NaN()));
  verdicts.abnormal.push_back(verdict.abnormal);
  verdicts.settling.push_back(verdict.settling);
  verdicts.suspicion.push_back(verdict.suspicion);
}

Verdicts judge(std::unique_ptr<core::Judge> judge, std::int64_t window,
               const core::Detector::Parameters& parameters, const RecordingEvents& arrays,
               const core::Vocabulary& vocabulary, ros1::ReplayedMonitor* monitor) {
  Verdicts verdicts;
  core::Alarms alarms;
  std::int64_t last_end = 0;  // of a window [ns]
  core::Detector detector(std::move(judge), window, parameters, [&](const core::Verdict& verdict) {
    record(verdict, verdicts);
    if (const std::optional<core::Alarm> ended = alarms.add(verdict, window, vocabulary)) {
      record(*ended, verdicts);
    }
    last_end = verdict.window->start + window;
    if (monitor != nullptr) {
      monitor->onVerdict(verdict);
    }
  });
  judgeRecording(detector, arrays, [&](const core::Event& event, bool same_clock) {
    if (const auto ended = same_clock ? std::nullopt : alarms.end(last_end)) {
      record(*ended, verdicts);
    }
    if (monitor != nullptr) {
      monitor->onEvent(event, same_clock);
    }
  });
  if (alarms.standing()) {
    record(*alarms.standing(), verdicts);
  }
  return verdicts;
}

Verdicts judgeByPaper(const std::shared_ptr<core::paper::Model>& model, std::int64_t window,
                      std::optional<double> threshold,
                      const core::Detector::Parameters& parameters, const py::object& recording,
                      ros1::ReplayedMonitor* monitor) {
  RecordingEvents arrays(recording);
  arrays.recording.waiting.clear();  // the paper's detector does not know the machine
  const auto vocabulary = std::make_shared<core::Vocabulary>(arrays.event_types);
  return judge(
      core::paper::makeJudge(model, threshold, parameters.silence_is_abnormal, vocabulary), window,
      parameters, arrays, *vocabulary, monitor);
}

Verdicts judgeByEvidence(const ros1::TrainedModel& trained,
                         const std::shared_ptr<core::evidence::Model>& model,
                         const core::Detector::Parameters& parameters, const py::object& recording,
                         ros1::ReplayedMonitor* monitor,
                         const std::vector<core::Acceptance>& accepted) {
  const RecordingEvents arrays(recording);
  const auto vocabulary = std::make_shared<core::Vocabulary>(arrays.event_types);
  const auto graph = std::make_shared<core::SourceGraph>(trained.graph);
  for (const auto& [source, host] : arrays.hosts) {
    graph->place(source, host);
  }
  std::unique_ptr<core::Judge> judge_of_it =
      core::evidence::makeJudge(model, trained.limits(), trained.window, graph, vocabulary);
  judge_of_it->accept(acceptancesOf(accepted));
  return judge(std::move(judge_of_it), trained.window, parameters, arrays, *vocabulary, monitor);
}

void bindVerdicts(py::module& m) {
  py::enum_<core::UnknownEvents>(m, "UnknownEvents",
                                 "What an unknown event means: nothing, a suspicion, or an alarm.")
      .value("IGNORE", core::UnknownEvents::kIgnore)
      .value("WARN", core::UnknownEvents::kWarn)
      .value("ERROR", core::UnknownEvents::kError);

  using Parameters = core::Detector::Parameters;
  py::class_<Parameters>(m, "DetectorParameters")
      .def(py::init<>())
      .def_readwrite("settle_time", &Parameters::settle_time, "[ns]")
      .def_readwrite("unknown", &Parameters::unknown);

  py::class_<core::Persistence>(
      m, "Persistence", "Decides when abnormal windows are an alarm, as the detector does.")
      .def(py::init([](const Parameters& parameters) {
             return core::Persistence(parameters.persistence);
           }),
           py::arg("parameters"))
      .def("add", &core::Persistence::add, py::arg("abnormal"), py::arg("end"),
           py::arg("certain") = false,
           "Takes in the next window; end: of the window [ns]. Returns whether the alarm stands.");

  py::class_<Verdicts>(m, "Verdicts", "One entry a window of a recording, and the alarms.")
      .def_property_readonly("start", arrayOf(&Verdicts::start), "of the window, int64 [ns]")
      .def_property_readonly("events", arrayOf(&Verdicts::events))
      .def_property_readonly("unknown", arrayOf(&Verdicts::unknown))
      .def_property_readonly("score", arrayOf(&Verdicts::score), "NaN for a window without events")
      .def_property_readonly("abnormal", arrayOf(&Verdicts::abnormal),
                             "eq. 5, or silence; also while settling")
      .def_property_readonly("settling", arrayOf(&Verdicts::settling))
      .def_property_readonly("suspicion", arrayOf(&Verdicts::suspicion),
                             "WARN: no alarm, but something was abnormal recently")
      .def_readonly("alarms", &Verdicts::alarms)
      .def_readonly("suspicions", &Verdicts::suspicions, "level WARN, each an Alarm");

  py::class_<core::paper::Model, std::shared_ptr<core::paper::Model>>(
      m, "PaperModel",
      "Probabilities, entropies and weights, computed from a TrainedModel's counts.")
      .def(py::init([](const ros1::TrainedModel& trained) {
             trained.requireDelays();
             return std::make_shared<core::paper::Model>(trained.statistics);
           }),
           py::arg("trained"))
      .def("weight", &core::paper::Model::weight, py::arg("from_id"), py::arg("to_id"),
           "w_ij once all event types were seen")
      .def("judge", &judgeByPaper, py::arg("window"), py::arg("threshold"), py::arg("parameters"),
           py::arg("recording"), py::arg("monitor") = nullptr,
           "Verdicts on a recording (recordings.RecordingEvents). window: [ns]; threshold None:\n"
           "not calibrated. monitor: a ReplayedMonitor that is told of all of it.");
  m.def("judge_by_evidence", &judgeByEvidence, py::arg("trained"), py::arg("model"),
        py::arg("parameters"), py::arg("recording"), py::arg("monitor") = nullptr,
        py::arg("accepted") = std::vector<core::Acceptance>(),
        "Verdicts on a recording by the EvidenceModel of a TrainedModel, like PaperModel.judge.\n"
        "accepted: what is normal besides.");
  m.attr("EVIDENCE_THRESHOLD") = core::evidence::kThreshold;
  m.attr("DEFAULT_WINDOW") = core::kDefaultWindow;    // [ns]
  m.attr("SHORTEST_WINDOW") = core::kShortestWindow;  // [ns]
  m.attr("LATEST_EVENT") = core::kLatestEvent;        // [ns]
  m.attr("LONGEST_SILENCE") = core::kLongestSilence;  // [ns]
  m.attr("LEAST_KNOWN") = core::kLeastKnown;
  m.attr("USUAL_SHARES") = py::make_tuple(core::kUsualFrom, core::kUsualTo);
}

void bindRoc(py::module& m) {
  using core::Roc;
  py::class_<Roc::Point>(m, "RocPoint")
      .def_readonly("cutoff", &Roc::Point::cutoff)
      .def_readonly("true_positive_rate", &Roc::Point::true_positive_rate)
      .def_readonly("false_positive_rate", &Roc::Point::false_positive_rate);
  py::class_<Roc>(m, "Roc", "Receiver operating characteristic of: abnormal if score < cut-off.")
      .def(py::init<std::vector<double>, std::vector<double>>(), py::arg("normal"),
           py::arg("abnormal"))
      .def_property_readonly("points", &Roc::points)
      .def_property_readonly("auc", &Roc::auc)
      .def("youden", &Roc::youden)
      .def("closest", &Roc::closest)
      .def("level", &Roc::level, py::arg("false_positive_rate"))
      .def("at", &Roc::at, py::arg("cutoff"));
}

/// What a whole recording says of each component, by stretch of time.
struct Lanes {
  std::vector<std::string> components;
  std::vector<evidence::Lanes::Column> columns;
};

py::array_t<float> sharesOf(const Lanes& lanes) {
  py::array_t<float> array({lanes.components.size(), lanes.columns.size()});
  auto values = array.mutable_unchecked<2>();
  for (std::size_t column = 0; column < lanes.columns.size(); ++column) {
    for (std::size_t component = 0; component < lanes.components.size(); ++component) {
      values(static_cast<py::ssize_t>(component), static_cast<py::ssize_t>(column)) =
          lanes.columns[column].shares[component];
    }
  }
  return array;
}

py::array_t<float> ofColumns(const Lanes& lanes, float evidence::Lanes::Column::*value) {
  std::vector<float> values;
  for (const evidence::Lanes::Column& column : lanes.columns) {
    values.push_back(column.*value);
  }
  return toArray(values);
}

Lanes lanesOf(const ros1::TrainedModel& trained, const std::shared_ptr<evidence::Model>& model,
              const core::Detector::Parameters& parameters, const py::object& recording,
              std::vector<std::int64_t> starts, const std::vector<core::Acceptance>& accepted) {
  RecordingEvents arrays(recording);
  arrays.missing.clear();  // neither is evidence
  arrays.senders.clear();
  evidence::Lanes lanes(model, std::move(starts));
  core::Detector detector(
      evidence::makeJudge(model, trained.limits(), trained.window,
                          std::make_shared<core::SourceGraph>(trained.graph),
                          std::make_shared<core::Vocabulary>(arrays.event_types),
                          [&](const core::Window& window, const evidence::Shares& shares) {
                            lanes.add(window, shares);
                          }),
      trained.window, parameters, [](const core::Verdict&) {});
  detector.accept(acceptancesOf(accepted));
  judgeRecording(detector, arrays);
  return {model->components(), lanes.columns()};
}

}  // namespace

void bindDetector(py::module& m) {
  bindVerdicts(m);
  bindRoc(m);
}

void bindLanes(py::module& m) {
  py::class_<Lanes>(m, "EvidenceLanes",
                    "What a recording says of each component, by stretch of time; in units of\n"
                    "the limits: 1 is the limit.")
      .def_readonly("components", &Lanes::components,
                    "sources, or topics where the sources are not known")
      .def_property_readonly("shares", &sharesOf,
                             "the largest share of its limit, float32 [components, stretches]")
      .def_property_readonly(
          "strongest",
          [](const Lanes& self) {
            return ofColumns(self, &evidence::Lanes::Column::strongest_share);
          },
          "the largest share of all tracks, float32 [stretches]")
      .def_property_readonly(
          "tracks",
          [](const Lanes& self) {
            std::vector<std::optional<std::size_t>> tracks;
            for (const evidence::Lanes::Column& column : self.columns) {
              tracks.push_back(column.track);
            }
            return tracks;
          },
          "index of the track with the largest share, by stretch; None: there is no evidence");
  m.def("evidence_lanes", &lanesOf, py::arg("trained"), py::arg("model"), py::arg("parameters"),
        py::arg("recording"), py::arg("starts"),
        py::arg("accepted") = std::vector<core::Acceptance>(),
        "EvidenceLanes of a recording, judged as by judge_by_evidence. starts: of the stretches\n"
        "[ns], in order; ValueError if they are not.");
}

}  // namespace self_awareness::python
