#include <pybind11/stl.h>
#include <ros/serialization.h>

#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bindings.h"
#include "core/evidence/log_bins.h"
#include "self_awareness/ros/bag/bag_reader.h"
#include "self_awareness/ros/model/evidence_message.h"
#include "self_awareness/ros/model/model_bytes.h"
#include "self_awareness/ros/model/model_file.h"
#include "self_awareness/ros/model/model_merge.h"
#include "self_awareness/ros/stable_name.h"

namespace self_awareness::python {
namespace {

// The progress bar is in Python, and Ctrl-C must work while C++ reads.
ros1::BagReader::Progress progressTo(const py::object& callback) {
  return [&callback](std::uint64_t done, std::uint64_t all) {
    if (PyErr_CheckSignals() != 0) {
      throw py::error_already_set();
    }
    if (!callback.is_none()) {
      callback(done, all);
    }
  };
}

ros1::TimeRange timeRange(std::optional<double> start, std::optional<double> end) {
  ros1::TimeRange range{start, end};
  range.validate();
  return range;
}

/// The events of a recording, in memory.
struct RecordedEvents {
  ros1::BagSummary summary;
  std::vector<core::EventType> event_types;  // the known ones first, then the new ones
  std::vector<std::int64_t> stamps;          // [ns]
  std::vector<std::uint32_t> ids;
};

// The array is a view of its owner's data, and keeps the owner alive: events may be many.
template <typename T>
py::array_t<T> viewOf(const std::vector<T>& values, const py::object& owner) {
  py::array_t<T> view(static_cast<py::ssize_t>(values.size()), values.data(), owner);
  view.attr("setflags")(py::arg("write") = false);
  return view;
}

RecordedEvents readEvents(const std::string& path, const ros1::EncodingRules& rules,
                          const std::vector<core::EventType>& known, const ros1::TimeRange& range,
                          const py::object& progress) {
  const ros1::BagReader reader(path);
  core::Vocabulary vocabulary(known);
  const ros1::Encoder encoder(
      rules, [&](const core::EventType& type) { return vocabulary.intern(type); });
  RecordedEvents events;
  events.summary = reader.summary();
  events.stamps.reserve(events.summary.messages);
  events.ids.reserve(events.summary.messages);
  reader.read(
      encoder, range,
      [&](const core::Event& event) {
        events.stamps.push_back(event.stamp);
        events.ids.push_back(event.id);
      },
      progressTo(progress));
  events.event_types = vocabulary.types();
  return events;
}

using EventTypeState = std::tuple<std::string, std::string, std::string>;
using EncodingState =
    std::tuple<bool, std::vector<std::string>, std::vector<std::string>, std::vector<std::string>,
               std::vector<std::string>, std::map<std::string, std::string>>;

EncodingState stateOf(const ros1::EncodingRules& rules) {
  return {rules.source == ros1::EncodingRules::Source::kNone,
          rules.include_topics,
          rules.exclude_topics,
          rules.include_sources,
          rules.exclude_sources,
          rules.type_fields};
}

ros1::EncodingRules fromState(const EncodingState& state) {
  ros1::EncodingRules rules;
  bool none = false;
  std::tie(none, rules.include_topics, rules.exclude_topics, rules.include_sources,
           rules.exclude_sources, rules.type_fields) = state;
  rules.source =
      none ? ros1::EncodingRules::Source::kNone : ros1::EncodingRules::Source::kCallerId;
  return rules;
}

void bindEncoding(py::module& m) {
  m.def("stable_name", &ros1::stableName, py::arg("name"),
        "A node's name without the number that makes it anonymous.");
  py::class_<core::EventType>(m, "EventType", "What happened: (source, scope, type).")
      .def(py::init<std::string, std::string, std::string>(), py::arg("source"), py::arg("scope"),
           py::arg("type"))
      .def_readonly("source", &core::EventType::source)
      .def_readonly("scope", &core::EventType::scope)
      .def_readonly("type", &core::EventType::type)
      .def("__str__", &core::toString)
      .def("__repr__",
           [](const core::EventType& self) { return "<EventType " + core::toString(self) + ">"; })
      .def("__eq__", [](const core::EventType& a, const core::EventType& b) { return a == b; })
      .def("__hash__",
           [](const core::EventType& self) { return py::hash(py::str(core::toString(self))); })
      .def(py::pickle(
          [](const core::EventType& self) {
            return EventTypeState{self.source, self.scope, self.type};
          },
          [](const EventTypeState& state) {
            return core::EventType{std::get<0>(state), std::get<1>(state), std::get<2>(state)};
          }));

  py::class_<ros1::EncodingRules>(m, "EncodingRules",
                                  "How messages become events; see config/encoding.yaml.")
      .def(py::init<>(), "Sources told apart, nothing excluded, no type fields.")
      .def_static("defaults", &ros1::EncodingRules::defaults)
      .def_property(
          "source",
          [](const ros1::EncodingRules& self) {
            return self.source == ros1::EncodingRules::Source::kNone ? "none" : "callerid";
          },
          [](ros1::EncodingRules& self, const std::string& source) {
            if (source != "none" && source != "callerid") {
              throw std::invalid_argument("source must be 'callerid' or 'none', not '" + source +
                                          "'");
            }
            self.source = source == "none" ? ros1::EncodingRules::Source::kNone
                                           : ros1::EncodingRules::Source::kCallerId;
          },
          "'callerid' or 'none'")
      .def_readwrite("include_topics", &ros1::EncodingRules::include_topics)
      .def_readwrite("exclude_topics", &ros1::EncodingRules::exclude_topics)
      .def_readwrite("include_sources", &ros1::EncodingRules::include_sources)
      .def_readwrite("exclude_sources", &ros1::EncodingRules::exclude_sources)
      .def_readwrite("type_fields", &ros1::EncodingRules::type_fields)
      .def("validate", &ros1::EncodingRules::validate,
           "ValueError if a pattern is no regular expression.")
      .def(py::pickle(&stateOf, &fromState))
      .def("__eq__",
           [](const ros1::EncodingRules& a, const ros1::EncodingRules& b) { return a == b; });
}

void bindBags(py::module& m) {
  py::register_exception<ros1::BagError>(m, "BagError", PyExc_RuntimeError);

  py::class_<ros1::BagSummary>(m, "BagSummary", "What a bag's index says about it.")
      .def_readonly("path", &ros1::BagSummary::path)
      .def_readonly("start", &ros1::BagSummary::start, "stamp of the first message [ns]")
      .def_readonly("end", &ros1::BagSummary::end, "stamp of the last message [ns]")
      .def_readonly("messages", &ros1::BagSummary::messages)
      .def_readonly("fingerprint", &ros1::BagSummary::fingerprint)
      .def_readonly("has_sources", &ros1::BagSummary::has_sources)
      .def_readonly("one_sender_a_topic", &ros1::BagSummary::one_sender_a_topic,
                    "Python's rosbag wrote it; further senders are under the name of the first")
      .def_readonly("copied", &ros1::BagSummary::copied,
                    "the same of a recording: by rosbag filter, compress or decompress");
  m.def(
      "summarise_bag", [](const std::string& path) { return ros1::BagReader(path).summary(); },
      py::arg("path"), "BagSummary of a bag. Raises BagError.");

  py::class_<RecordedEvents>(m, "RecordedEvents", "The events of a recording, in memory.")
      .def_readonly("summary", &RecordedEvents::summary)
      .def_readonly("event_types", &RecordedEvents::event_types, "by id")
      .def_property_readonly(
          "stamps",
          [](const py::object& self) {
            return viewOf(self.cast<const RecordedEvents&>().stamps, self);
          },
          "int64 [ns], read-only")
      .def_property_readonly(
          "ids",
          [](const py::object& self) {
            return viewOf(self.cast<const RecordedEvents&>().ids, self);
          },
          "uint32, read-only");
  m.def(
      "read_events",
      [](const std::string& path, const ros1::EncodingRules& encoding,
         const std::vector<core::EventType>& event_types, std::optional<double> start,
         std::optional<double> end, const py::object& progress) {
        return readEvents(path, encoding, event_types, timeRange(start, end), progress);
      },
      py::arg("path"), py::arg("encoding"),
      py::arg("event_types") = std::vector<core::EventType>(), py::arg("start") = py::none(),
      py::arg("end") = py::none(), py::arg("progress") = py::none(),
      "RecordedEvents of a bag: stamps (int64 [ns]) and ids (uint32). Ids below len(event_types)\n"
      "stand for these, the ids after them for new types. start, end: seconds from the\n"
      "recording's first message. Calls progress(done, all) from time to time. Raises BagError.");
}

std::vector<std::pair<std::int64_t, std::uint64_t>> delaysOf(const ros1::TrainedModel& model,
                                                             core::EventId from,
                                                             core::EventId to) {
  std::vector<std::pair<std::int64_t, std::uint64_t>> delays;
  for (std::size_t bin = 0; bin < core::evidence::kDelayBins; ++bin) {
    std::uint64_t count = 0;
    for (const core::evidence::Statistics& half : model.evidence) {
      count += half.delays(from, to)[bin];
    }
    delays.emplace_back(core::evidence::log_bins::lowerEdge(bin), count);
  }
  return delays;
}

// Of an edge of the graph: publisher, topic, subscriber.
using EdgeState = std::tuple<std::string, std::string, std::string>;

void bindModel(py::module& m) {
  py::register_exception<ros1::ModelFileError>(m, "ModelFileError", PyExc_RuntimeError);

  py::class_<self_awareness::Recording>(m, "Recording", "msg/Recording.msg")
      .def(py::init<>())
      .def_readwrite("bag", &self_awareness::Recording::bag)
      .def_property(
          "start", [](const self_awareness::Recording& self) { return self.start.toNSec(); },
          [](self_awareness::Recording& self, std::uint64_t ns) { self.start.fromNSec(ns); },
          "[ns]")
      .def_property(
          "end", [](const self_awareness::Recording& self) { return self.end.toNSec(); },
          [](self_awareness::Recording& self, std::uint64_t ns) { self.end.fromNSec(ns); }, "[ns]")
      .def_readwrite("events", &self_awareness::Recording::events)
      .def_readwrite("fingerprint", &self_awareness::Recording::fingerprint);

  using self_awareness::Calibration;
  py::class_<Calibration>(m, "Calibration", "msg/Calibration.msg")
      .def(py::init<>())
      .def_readwrite("threshold", &Calibration::threshold)
      .def_readwrite("method", &Calibration::method)
      .def_readwrite("auc", &Calibration::auc)
      .def_readwrite("true_positive_rate", &Calibration::true_positive_rate)
      .def_readwrite("false_positive_rate", &Calibration::false_positive_rate)
      .def_readwrite("normal_windows", &Calibration::normal_windows)
      .def_readwrite("faulty_windows", &Calibration::faulty_windows)
      .def_readwrite("false_alarms_per_hour", &Calibration::false_alarms_per_hour)
      .def_readwrite("normal", &Calibration::normal)
      .def_readwrite("faulty", &Calibration::faulty)
      .def_readwrite("injected", &Calibration::injected)
      .def_property(
          "stamp", [](const Calibration& self) { return self.stamp.toNSec(); },
          [](Calibration& self, std::uint64_t ns) { self.stamp.fromNSec(ns); }, "[ns]");

  using self_awareness::EvidenceCalibration;
  py::class_<EvidenceCalibration>(m, "EvidenceCalibration", "msg/EvidenceCalibration.msg")
      .def(py::init<>())
      .def_readwrite("method", &EvidenceCalibration::method)
      .def_readwrite("limits", &EvidenceCalibration::limits)
      .def_readwrite("linker_limit", &EvidenceCalibration::linker_limit)
      .def_property(
          "relations",
          [](const EvidenceCalibration& self) {
            std::vector<core::evidence::Relation> relations;
            for (const self_awareness::Relation& relation : self.relations) {
              relations.push_back(ros1::fromMessage(relation));
            }
            return relations;
          },
          [](EvidenceCalibration& self, const std::vector<core::evidence::Relation>& relations) {
            self.relations.clear();
            for (const core::evidence::Relation& relation : relations) {
              self.relations.push_back(ros1::toMessage(relation));
            }
          },
          "what speaks for watching each track; by track")
      .def_readwrite("firsts", &EvidenceCalibration::firsts)
      .def_readwrite("budget", &EvidenceCalibration::budget)
      .def_readwrite("false_alarms_per_hour", &EvidenceCalibration::false_alarms_per_hour)
      .def_readwrite("windows", &EvidenceCalibration::windows)
      .def_readwrite("recordings", &EvidenceCalibration::recordings)
      .def_property(
          "stamp", [](const EvidenceCalibration& self) { return self.stamp.toNSec(); },
          [](EvidenceCalibration& self, std::uint64_t ns) { self.stamp.fromNSec(ns); }, "[ns]");

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
      .def("watch", &TrainedModel::watch, "Chooses what is watched, by all counts.")
      .def(
          "watched_only",
          [](TrainedModel self) {
            self.dropCounts();
            return self;
          },
          "A small copy, with only the counts that the evidence detector judges by.")
      .def_readonly("predecessors", &TrainedModel::predecessors,
                    "most that are watched of an event type")
      .def_readonly("least_effect", &TrainedModel::least_effect)
      .def(
          "swap_halves", [](TrainedModel& self) { std::swap(self.evidence[0], self.evidence[1]); },
          "Exchanges the two halves of the training; not for a model with a calibration.")
      .def(py::pickle([](const TrainedModel& self) { return py::bytes(ros1::toBytes(self)); },
                      [](const py::bytes& state) { return ros1::fromBytes(state); }))
      .def_readonly("encoding", &TrainedModel::encoding)
      .def_readonly("window", &TrainedModel::window, "length of a window [ns]")
      .def_property_readonly(
          "recordings",
          [](const TrainedModel& self) { return self.recordings; },  // a copy: merge() moves them
          "trained on")
      .def_property_readonly(
          "stamp", [](const TrainedModel& self) { return self.stamp.toNSec(); }, "[ns]")
      .def_readwrite("calibration", &TrainedModel::calibration,
                     "of the paper's detector; None: not calibrated")
      .def_readwrite("findings", &TrainedModel::findings,
                     "LimitFindings of the recordings of the training")
      .def_readwrite("evidence_calibration", &TrainedModel::evidence_calibration,
                     "of the evidence detector; None: not calibrated")
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
            self.graph = {};
            for (const auto& [publisher, topic, subscriber] : edges) {
              self.graph.connect(publisher, topic, subscriber);
            }
          },
          "whose messages reach whom: set of (publisher, topic, subscriber), nodes by their\n"
          "stable names; empty: not known")
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
      .def("delays", &delaysOf, py::arg("from_id"), py::arg("to_id"),
           "the evidence detector's counts: list of (shortest delay [ns], count) by bin")
      .def(
          "quantile",
          [](const TrainedModel& self, core::EventId from, core::EventId to, double fraction) {
            return self.statistics.pair(from, to).quantile(fraction);
          },
          py::arg("from_id"), py::arg("to_id"), py::arg("fraction"),
          "by the paper's counts: the bin up to which the fraction of the pair's delays lies;\n"
          "0 if there is none");
}

}  // namespace

void bindFiles(py::module& m) {
  bindEncoding(m);
  bindBags(m);
  bindModel(m);
}

}  // namespace self_awareness::python
