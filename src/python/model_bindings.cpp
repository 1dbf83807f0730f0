#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bindings.h"
#include "core/evidence/count/starts.h"
#include "self_awareness/core/verdict/suspect.h"
#include "self_awareness/ros/model/model_file.h"
#include "self_awareness/ros/model/model_merge.h"

namespace self_awareness::python {
namespace {

using HeardIn = std::tuple<std::string, std::int64_t, std::int64_t, std::set<core::EventType>>;

std::vector<HeardIn> heardIn(const ros1::TrainedModel& model) {
  std::vector<HeardIn> heard;
  for (const core::evidence::Statistics& half :
       model.hasEvidence() ? model.evidence : model.watched.halves) {
    for (const core::evidence::Statistics::Recording& recording : half.recordings()) {
      std::set<core::EventType> types;
      for (core::EventId id = 0; id < recording.events.size(); ++id) {
        if (recording.events[id] > 0) {
          types.insert(half.vocabulary().at(id));
        }
      }
      heard.emplace_back(recording.robot,
                         recording.robot_start > 0 ? recording.robot_start : recording.start,
                         recording.end, std::move(types));
    }
  }
  return heard;
}

/// Gaps that an event type needs to be judged; the evidence detector's number can be set.
std::uint64_t fewestGaps(const ros1::TrainedModel& model) {
  return model.detectors() == "paper"
             ? core::kFewestGaps
             : static_cast<std::uint64_t>(std::ceil(model.tuning.fewest_gaps));
}

}  // namespace

void bindModel(py::module& m) {
  py::register_exception<ros1::ModelFileError>(m, "ModelFileError", PyExc_RuntimeError);

  using core::RecordingInfo;
  py::class_<RecordingInfo>(m, "Recording", "What a model says of a recording.")
      .def(py::init<>())
      .def_readwrite("bag", &RecordingInfo::bag, "the file's name, without its folder")
      .def_readwrite("start", &RecordingInfo::start, "[ns]")
      .def_readwrite("end", &RecordingInfo::end, "[ns]")
      .def_readwrite("robot_start", &RecordingInfo::robot_start, "[ns]; 0: not known")
      .def_readwrite("robot", &RecordingInfo::robot, "its name; empty: not known")
      .def_readwrite("events", &RecordingInfo::events)
      .def_readwrite("fingerprint", &RecordingInfo::fingerprint, "of the whole recording");

  using PaperCalibration = core::paper::Calibration;
  py::class_<PaperCalibration>(m, "PaperCalibration",
                               "The threshold of the paper's score, and how it was found.")
      .def(py::init<>())
      .def_readwrite("threshold", &PaperCalibration::threshold)
      .def_readwrite("method", &PaperCalibration::method, "youden, closest or fpr=RATE")
      .def_readwrite("auc", &PaperCalibration::auc)
      .def_readwrite("true_positive_rate", &PaperCalibration::true_positive_rate)
      .def_readwrite("false_positive_rate", &PaperCalibration::false_positive_rate)
      .def_readwrite("normal_windows", &PaperCalibration::normal_windows)
      .def_readwrite("faulty_windows", &PaperCalibration::faulty_windows)
      .def_readwrite("false_alarms_per_hour", &PaperCalibration::false_alarms_per_hour)
      .def_readwrite("normal", &PaperCalibration::normal)
      .def_readwrite("faulty", &PaperCalibration::faulty)
      .def_readwrite("injected", &PaperCalibration::injected)
      .def_readwrite("stamp", &PaperCalibration::stamp, "[ns]");

  using core::Calibration;
  py::class_<Calibration>(m, "Calibration",
                          "From where on evidence is abnormal, and how that was found.")
      .def(py::init<>())
      .def_readwrite("method", &Calibration::method, "held-out or cross-fit")
      .def_property(
          "limits", [](const Calibration& self) { return self.limits.tracks; },
          [](Calibration& self, std::vector<double> limits) {
            self.limits.tracks = std::move(limits);
          },
          "the largest evidence that is normal, by track; NaN: not judged")
      .def_readwrite("relations", &Calibration::relations,
                     "what speaks for watching each track; by track")
      .def_readwrite("budget", &Calibration::budget, "false alarms an hour that the limits allow")
      .def_readwrite("false_alarms_per_hour", &Calibration::false_alarms_per_hour,
                     "to be expected")
      .def_readwrite("windows", &Calibration::windows, "that were looked at")
      .def_readwrite("recordings", &Calibration::recordings)
      .def_readwrite("stamp", &Calibration::stamp, "[ns]");

  using core::evidence::Coverage;
  py::class_<Coverage>(m, "Coverage", "How soon faults of a component are found.")
      .def_readonly_static("MOST_STARTS", &Coverage::kMostStarts,
                           "what needs more starts than so many is not told")
      .def_readonly("component", &Coverage::component)
      .def_readonly("period", &Coverage::period,
                    "mean gap of what comes most often [s]; 0: nothing came twice")
      .def_readonly("gaps", &Coverage::gaps, "in training, of what has most of them")
      .def_readonly("death_found_after", &Coverage::death_found_after,
                    "longest time from its last event to the alarm [s]; None: its silence is not\n"
                    "judged")
      .def_readonly("found_when_asked", &Coverage::found_when_asked,
                    "longest time to the alarm while others ask it, or go on that pause when it\n"
                    "does [s]; None: nobody does")
      .def_property_readonly(
          "found_after",
          [](const Coverage& self) { return core::evidence::foundAfter(self, " s"); },
          "both in words, as /diagnostics says them; empty: neither")
      .def_readonly("late_answers", &Coverage::late_answers,
                    "how much later than usual they must be to be found [s]")
      .def_readonly("more_starts", &Coverage::more_starts,
                    "of the robot, after which they would be; 0: no number helps")
      .def_property_readonly("late_answers_found", &core::evidence::lateAnswers,
                             "the three in words, as /diagnostics says them; empty: never")
      .def_property_readonly("is_watched", &Coverage::isWatched, "whether its death is found")
      .def_property_readonly(
          "blind",
          [](const Coverage& self) {
            std::vector<std::tuple<std::string, std::string, std::string>> blind;
            for (const Coverage::Blind& each : self.blind) {
              blind.emplace_back(each.about, each.topic, each.why);
            }
            return blind;
          },
          "what is not judged of which topic, and why: ('content', '/fix', 'it repeated for "
          "...')");

  using ros1::TrainedModel;
  py::class_<TrainedModel>(m, "TrainedModel", "All that a model file holds: counts.")
      .def_static(
          "load",
          [](const std::string& path, bool watched_only) {
            return ros1::loadModel(
                path, watched_only ? ros1::ModelCounts::kWatched : ros1::ModelCounts::kAll);
          },
          py::arg("path"), py::arg("watched_only") = false,
          "watched_only: only the counts that the evidence detector judges by, as the monitor\n"
          "does: quick and small. Raises ModelFileError.")
      .def("save", &ros1::saveModel, py::arg("path"),
           "Raises ModelFileError; writes all or nothing.")
      .def("merge", &ros1::merge, py::arg("other"),
           "Adds what another model learned, and drops the calibrations; watch() must follow.\n"
           "ValueError if they do not count the same things.")
      .def(
          "add_renames",
          [](TrainedModel& self, const std::vector<std::pair<std::string, std::string>>& rules) {
            std::vector<ros1::Rename> renames;
            for (const auto& [pattern, name] : rules) {
              renames.push_back({pattern, name});
            }
            ros1::rename(self, renames);
          },
          py::arg("rename"),
          "Renames what it has learned by these rules, after those of its encoding, and drops\n"
          "the calibrations; watch() must follow. ValueError if two event types become one.")
      .def("watch", &TrainedModel::watch, "Chooses what is watched, by all counts.")
      .def(
          "watched_only",
          [](TrainedModel self) {
            self.dropCounts();
            return self;
          },
          "A small copy, with only the counts that the evidence detector judges by.")
      .def(
          "starts_of",
          [](const TrainedModel& self, const std::vector<core::RecordingInfo>& recordings) {
            std::vector<core::evidence::Span> spans;
            spans.reserve(recordings.size());
            for (const core::RecordingInfo& each : recordings) {
              spans.push_back({each.start, each.end, each.robot_start, each.robot});
            }
            return core::evidence::numberOfStarts(spans,
                                                  core::toNanoseconds(self.tuning.start_time));
          },
          py::arg("recordings"), "How many starts of robots recordings are of.")
      .def("coverage", &TrainedModel::coverage,
           "Coverage of each component by the evidence detector; none: not calibrated.")
      .def_property_readonly(
          "tuning", [](const TrainedModel& self) { return self.tuning; },
          "a copy of the numbers of the method")
      .def(py::pickle([](const TrainedModel& self) { return py::bytes(ros1::toBytes(self)); },
                      [](const py::bytes& state) { return ros1::fromBytes(state); }))
      .def_readonly("encoding", &TrainedModel::encoding)
      .def_readonly("window", &TrainedModel::window, "length of a window [ns]")
      .def_property_readonly(
          "recordings",
          [](const TrainedModel& self) { return self.recordings; },  // a copy: merge() moves them
          "trained on")
      .def_readonly("stamp", &TrainedModel::stamp, "when it was trained [ns]")
      .def_readonly("version", &TrainedModel::version,
                    "FileVersion of its file; of this version if it has none")
      .def_readonly("left_out", &TrainedModel::left_out,
                    "channels that its file watches and this version does not have")
      .def_property(
          "paper_calibration", copyOf<TrainedModel>(&TrainedModel::paper_calibration),
          [](TrainedModel& self, std::optional<core::paper::Calibration> calibration) {
            self.paper_calibration = std::move(calibration);
          },
          "a copy of the PaperCalibration; None: not calibrated")
      .def_readwrite("findings", &TrainedModel::findings,
                     "LimitFindings of the recordings of the training")
      .def_property(
          "calibration", copyOf<TrainedModel>(&TrainedModel::calibration),
          [](TrainedModel& self, std::optional<core::Calibration> calibration) {
            self.calibration = std::move(calibration);
          },
          "a copy of the Calibration of the evidence detector; None: not calibrated")
      .def_property(
          "graph",
          [](const TrainedModel& self) {
            std::set<EdgeState> edges;
            for (const auto& [publisher, topic, subscriber] : self.graph.edges()) {
              edges.emplace(publisher, topic, subscriber);
            }
            return edges;
          },
          [](TrainedModel& self, const std::set<EdgeState>& edges) {
            const core::SourceGraph before = std::exchange(self.graph, graphOf(edges));
            for (const auto& [source, host] : before.hosts()) {
              self.graph.place(source, host);
            }
            for (const core::SourceGraph::Publication& publication : before.unheard()) {
              self.graph.addUnheard(publication);
            }
            for (const auto& [subscription, recordings] : before.lasting()) {
              self.graph.addLasting(subscription, recordings);
            }
          },
          "whose messages reach whom: set of (publisher, topic, subscriber), nodes by their\n"
          "stable names; empty: not known")
      .def_property(
          "hosts", [](const TrainedModel& self) { return self.graph.hosts(); },
          [](TrainedModel& self, const HostsState& hosts) {
            for (const auto& [source, host] : hosts) {
              self.graph.place(source, host);
            }
          },
          "computers of sources, as a dict; those that are known, or '' where a source runs on\n"
          "several. To set it keeps those of other sources.")
      .def_property(
          "unheard", &TrainedModel::unheard,
          [](TrainedModel& self, const std::set<core::SourceGraph::Publication>& unheard) {
            for (const core::SourceGraph::Publication& publication : unheard) {
              self.graph.addUnheard(publication);
            }
          },
          "what sources published in training, and nobody subscribed to: set of (source, topic).\n"
          "To set it adds to what is known; what the model has events of is left out.")
      .def(
          "add_subscriptions",
          [](TrainedModel& self, const std::set<core::SourceGraph::Subscription>& lasting) {
            for (const core::SourceGraph::Subscription& subscription : lasting) {
              self.graph.addLasting(subscription);
            }
          },
          py::arg("lasting"),
          "Adds what nodes subscribed to all the time in one further recording: (node, topic).")
      .def_property_readonly(
          "subscriptions", &TrainedModel::expectedSubscriptions,
          "what components subscribed to in every start of the training: set of (node, topic);\n"
          "empty: it is not known of all recordings, or there was one start")
      .def_property_readonly(
          "heard_in", &heardIn,
          "what the evidence detector heard in each recording of the training: (robot, start of\n"
          "the robot, or else of the recording [ns], end of it [ns], set of event types)")
      .def_property_readonly("threshold", &TrainedModel::threshold, "None: not calibrated")
      .def_property_readonly(
          "bin_size", [](const TrainedModel& self) { return self.statistics.binning().bin_size; },
          "[ns]")
      .def_property_readonly(
          "horizon_bins",
          [](const TrainedModel& self) { return self.statistics.binning().horizon_bins; },
          "0: unbounded")
      .def_property_readonly(
          "event_types",
          [](const TrainedModel& self) { return self.statistics.vocabulary().types(); }, "by id")
      .def_property_readonly("events",
                             [](const TrainedModel& self) { return self.statistics.events(); })
      .def_property_readonly("detectors", &TrainedModel::detectors,
                             "what it was trained for: evidence, paper or both")
      .def(
          "require",
          [](const TrainedModel& self, const std::string& detector) {
            if (detector == "paper") {
              self.requireDelays();
            } else {
              self.requireWatched();
            }
          },
          py::arg("detector"),
          "ValueError if it was not trained for this detector (evidence or paper)")
      .def_property_readonly("pairs", &TrainedModel::pairs,
                             "number of ordered pairs with at least one delay")
      .def("gaps", &TrainedModel::gaps, py::arg("id"), "number of gaps between two of a type")
      .def(
          "longest_gap",
          [](const TrainedModel& self, core::EventId id) {
            return std::max(self.watched.halves[0].type(id).longestGap(),
                            self.watched.halves[1].type(id).longestGap());
          },
          py::arg("id"), "longest gap between two of a type [ns]; 0: there was none")
      .def_property_readonly("fewest_gaps", &fewestGaps,
                             "gaps that an event type needs to be judged")
      .def("event_count", [](const TrainedModel& self,
                             core::EventId id) { return self.statistics.eventCount(id); })
      .def(
          "histogram",
          [](const TrainedModel& self, core::EventId from, core::EventId to) {
            std::map<std::int64_t, std::uint64_t> counts;
            for (const core::paper::Histogram::Entry& entry :
                 self.statistics.pair(from, to).entries()) {
              counts[entry.bin] = entry.count;
            }
            return counts;
          },
          py::arg("from_id"), py::arg("to_id"),
          "the paper's counts of the delays from the last from_id to the current to_id: dict of\n"
          "bin: count")
      .def(
          "quantile",
          [](const TrainedModel& self, core::EventId from, core::EventId to, double fraction) {
            return self.statistics.pair(from, to).quantile(fraction);
          },
          py::arg("from_id"), py::arg("to_id"), py::arg("fraction"),
          "by the paper's counts: the bin up to which the fraction of the pair's delays lies;\n"
          "0 if there is none");
}

}  // namespace self_awareness::python
