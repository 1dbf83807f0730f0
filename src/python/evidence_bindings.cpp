#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bindings.h"
#include "core/evidence/channel/scorer.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/evidence/limits/cross_fit.h"
#include "self_awareness/core/evidence/limits/limits.h"
#include "self_awareness/ros/model/model_file.h"

namespace self_awareness::python {
namespace {

namespace evidence = core::evidence;

/// A search for limits, with the models that judge the recordings.
struct LimitSearch {
  LimitSearch(std::shared_ptr<const evidence::CrossFit> models,
              const evidence::LimitFinder::Parameters& parameters, const core::SourceGraph& graph)
      : cross_fit(std::move(models)), finder(cross_fit->model(), parameters, graph) {}

  /// A search without findings, for the same model.
  std::unique_ptr<LimitSearch> part() const {
    return std::make_unique<LimitSearch>(cross_fit, finder.parameters(), finder.graph());
  }
  void addEvents(const Stamps& stamps, const Ids& ids, std::optional<std::size_t> half,
                 std::int64_t robot_start, std::vector<std::int64_t> clock_steps) {
    const core::ClockSteps steps(std::move(clock_steps));
    const py::gil_scoped_release release;
    finder.startRecording(cross_fit->judging(half), robot_start);
    forEachEvent(
        stamps, ids, steps, [&](const core::Event& event) { finder.add(event); },
        [&] { finder.restart(); });
    finder.finish();
  }

  std::shared_ptr<const evidence::CrossFit> cross_fit;
  evidence::LimitFinder finder;
};

using Findings = evidence::LimitFinder::Findings;
using PartState = std::tuple<std::uint64_t, std::vector<float>, std::vector<std::int64_t>>;
using RecordingState = std::tuple<std::int64_t, std::int64_t, std::int64_t, bool, std::uint64_t,
                                  std::vector<PartState>, std::vector<std::uint8_t>>;
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
                       recording.windows, parts, said);
  }
  return state;
}

Findings fromState(const FindingsState& state) {
  Findings findings;
  for (const auto& [start, end, robot_start, trained_on, windows, parts, said] : state) {
    evidence::LimitFinder::Recording& recording = findings.emplace_back();
    recording.start = start;
    recording.end = end;
    recording.robot_start = robot_start;
    recording.trained_on = trained_on;
    recording.windows = windows;
    for (const auto& [part_windows, evidence, gaps] : parts) {
      recording.parts.push_back({part_windows, evidence, gaps});
    }
    for (const std::uint8_t each : said) {
      recording.said.push_back(static_cast<evidence::Said>(each));
    }
  }
  return findings;
}

/// The evidence of every track at the end of every window.
class EvidenceRows : public core::WindowObserver {
 public:
  EvidenceRows(const std::shared_ptr<const evidence::Model>& model, std::int64_t window,
               const std::optional<std::vector<double>>& limits)
      : model_(*model), scorer_(model, window), window_(window) {
    if (!limits) {
      return;
    }
    if (limits->size() != model->tracks().size()) {
      throw std::invalid_argument("limits: one of each track is needed");
    }
    scorer_.capAt({*limits, {}});
  }

  core::ObservedEvent observe(const core::Event& event) override {
    return {event, !model_.knows(event.id), scorer_.add(event)};
  }
  void close(const core::Window& window, std::int64_t /*end*/) override {
    const std::vector<double>& evidence = scorer_.closeWindow(window.start + window_);
    rows_.insert(rows_.end(), evidence.begin(), evidence.end());
  }
  void onClockStep() override { scorer_.restart(); }

  const std::vector<double>& rows() const { return rows_; }

 private:
  const evidence::Model& model_;
  evidence::Scorer scorer_;
  std::int64_t window_;
  std::vector<double> rows_;
};

/// Evidence of a recording, [windows, tracks].
py::array_t<double> evidenceOf(const std::shared_ptr<evidence::Model>& model, std::int64_t window,
                               const Stamps& stamps, const Ids& ids,
                               const std::optional<std::vector<double>>& limits) {
  EvidenceRows observer(model, window, limits);
  core::Windows windows(window, observer);
  forEachEvent(stamps, ids, [&](const core::Event& event) { windows.add(event); });
  windows.finish();
  const std::size_t tracks = model->tracks().size();
  const std::vector<double>& rows = observer.rows();
  py::array_t<double> array({tracks == 0 ? 0 : rows.size() / tracks, tracks});
  std::copy(rows.begin(), rows.end(), array.mutable_data());
  return array;
}

}  // namespace

void bindEvidence(py::module& m) {
  using evidence::Track;
  py::class_<Track>(m, "Track", "One thing that the evidence detector watches.")
      .def_property_readonly(
          "channel", [](const Track& self) { return evidence::channelLabel(self); },
          "as people read it: overdue, rate, pairs or deadlines")
      .def_property_readonly(
          "name", [](const Track& self) { return evidence::channelName(self); },
          "of the channel (Tuning.channels)")
      .def_readonly("to_id", &Track::to)
      .def_readonly("from_id", &Track::from,
                    "same as to_id if the channel looks at one event type");

  py::class_<evidence::Model, std::shared_ptr<evidence::Model>>(
      m, "EvidenceModel", "What normal operation lets expect, from a TrainedModel's counts.")
      .def(py::init([](const ros1::TrainedModel& trained) {
             trained.requireWatched();
             return std::make_shared<evidence::Model>(trained.watched);
           }),
           py::arg("trained"))
      .def_property_readonly("tracks", &evidence::Model::tracks)
      .def(
          "usual_delay",
          [](const evidence::Model& self, core::EventId from, core::EventId to, double share) {
            return self.usualDelay(from, to, share) * 1e-9;
          },
          py::arg("from_id"), py::arg("to_id"), py::arg("share"),
          "delay [s] that this share (0 to 1) of the delays in training did not exceed,\n"
          "as exactly as the bins are")
      .def(
          "delays",
          [](const evidence::Model& self, core::EventId from, core::EventId to) {
            return delaysOf(self.statistics(), from, to);
          },
          py::arg("from_id"), py::arg("to_id"),
          "counts of the delays in training, of what is watched: list of (shortest delay [ns],\n"
          "count) by bin; zeros for other pairs")
      .def("overdue", &evidence::Model::overdue, py::arg("id"), py::arg("age"), "age: [ns]")
      .def("log_survival", &evidence::Model::logSurvival, py::arg("id"), py::arg("age"))
      .def("evidence", &evidenceOf, py::arg("window"), py::arg("stamps"), py::arg("ids"),
           py::arg("limits") = py::none(),
           "Evidence at the end of every window of a recording: float64 [windows, tracks].\n"
           "limits: by track, which sums end a little above; NaN: not judged. None: not known.");

  py::class_<evidence::Relation>(m, "Relation", "What speaks for a relation.")
      .def_readonly("watched", &evidence::Relation::watched)
      .def_readonly("reaches", &evidence::Relation::reaches)
      .def_readonly("irregular", &evidence::Relation::irregular)
      .def_readonly("spread", &evidence::Relation::spread)
      .def_readonly("starts", &evidence::Relation::starts)
      .def_readonly("starts_needed", &evidence::Relation::starts_needed);

  py::class_<Findings>(m, "LimitFindings",
                       "What a LimitFinder learned from recordings; may go to another process.")
      .def(py::init<>(), "Of no recording.")
      .def(py::pickle([](const Findings& self) { return stateOf(self); },
                      [](const FindingsState& state) { return fromState(state); }));

  using Found = evidence::LimitFinder::Found;
  py::class_<Found>(m, "LimitsFound", "What comes of LimitFindings.")
      .def_property_readonly(
          "limits", [](const Found& self) { return self.limits.tracks; },
          "the largest evidence that is normal, by track; NaN: not judged")
      .def_readonly("expected_rate", &Found::expected_rate, "false alarms an hour to be expected")
      .def_readonly("relations", &Found::relations, "by track");

  py::class_<LimitSearch>(
      m, "LimitFinder",
      "Finds limits on recordings of normal operation.\n"
      "Other finders, in other processes, may judge some of them; merge() adds their findings.")
      .def(
          py::init([](const ros1::TrainedModel& trained, std::int64_t settle_time, double budget) {
            trained.requireWatched();
            return std::make_unique<LimitSearch>(
                std::make_shared<evidence::CrossFit>(trained.watched),
                evidence::LimitFinder::Parameters{trained.window, settle_time, budget},
                trained.graph);
          }),
          py::arg("trained"), py::arg("settle_time"), py::arg("budget"),
          "settle_time: [ns]; budget: false alarms an hour")
      .def("add_events", &LimitSearch::addEvents, py::arg("stamps"), py::arg("ids"),
           py::arg("half") = py::none(), py::arg("robot_start") = 0,
           py::arg("clock_steps") = std::vector<std::int64_t>(),
           "Takes in a recording; half: 0 or 1 if that half of the training learned from it;\n"
           "robot_start: of the robot [ns], 0: not known; clock_steps: with which the clock was\n"
           "set forward (find_clock_steps).")
      .def("part", &LimitSearch::part, "A finder without findings, for the same model.")
      .def(
          "findings", [](const LimitSearch& self) { return self.finder.findings(); },
          "LimitFindings of what was added.")
      .def(
          "merge",
          [](LimitSearch& self, const Findings& findings) { self.finder.merge(findings); },
          py::arg("findings"))
      .def(
          "find", [](const LimitSearch& self) { return self.finder.find(); },
          "LimitsFound; ValueError if the recordings were too short.")
      .def_property_readonly("windows",
                             [](const LimitSearch& self) { return self.finder.windows(); });
}

}  // namespace self_awareness::python
