#include <pybind11/stl.h>
#include <sys/stat.h>

#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bindings.h"
#include "ros/bag/log_lines.h"
#include "ros/bag/open_bag.h"
#include "ros/bag/recording_files.h"
#include "self_awareness/ros/bag/bag_reader.h"
#include "self_awareness/ros/bag/event_log_reader.h"

namespace self_awareness::python {
namespace {

ros1::TimeRange timeRange(std::optional<double> start, std::optional<double> end) {
  ros1::TimeRange range{start, end};
  range.validate();
  return range;
}

/// Begin and end of a stretch of time, and how long the machine kept its processes waiting for a
/// processor in it [ns].
using WaitingState = std::tuple<std::int64_t, std::int64_t, std::int64_t>;

/// The events of a recording, in memory.
struct RecordedEvents {
  ros1::BagSummary summary;
  std::vector<core::EventType> event_types;  // the known ones first, then the new ones
  std::vector<std::int64_t> stamps;          // [ns]
  std::vector<std::uint32_t> ids;
  std::vector<std::uint32_t> attributes;  // core::packed(); 0: not known
  std::vector<WaitingState> waiting;
  std::vector<SenderState> senders;
};

/// The getter of a member. The array is a view of its owner's data, and keeps the owner alive:
/// events may be many.
template <typename T>
auto viewOf(std::vector<T> RecordedEvents::*member) {
  return [member](const py::object& owner) {
    const std::vector<T>& values = owner.cast<const RecordedEvents&>().*member;
    py::array_t<T> view(static_cast<py::ssize_t>(values.size()), values.data(), owner);
    view.attr("setflags")(py::arg("write") = false);
    return view;
  };
}

py::array_t<std::uint32_t> packAttributes(const py::array_t<double>& ages,
                                          const py::array_t<std::uint64_t>& sizes,
                                          const py::array_t<std::int64_t>& steps,
                                          const py::array_t<bool>& same) {
  const auto age = ages.unchecked<1>();
  const auto size = sizes.unchecked<1>();
  const auto step = steps.unchecked<1>();
  const auto is_same = same.unchecked<1>();
  if (size.size() != age.size() || step.size() != age.size() || is_same.size() != age.size()) {
    throw std::invalid_argument("attributes must be arrays of one length");
  }
  std::vector<std::uint32_t> packed;
  for (py::ssize_t i = 0; i < age.size(); ++i) {
    core::Attributes attributes;
    attributes.age = std::isnan(age(i))   ? core::Attributes::kNoAge
                     : std::isinf(age(i)) ? core::Attributes::kZeroStamp
                                          : core::ageClass(core::toNanoseconds(age(i)));
    attributes.size = core::sizeClass(size(i));
    attributes.step = step(i) < 0 ? core::Attributes::Step::kNotKnown
                                  : core::stepOf(0, static_cast<std::uint32_t>(step(i)));
    attributes.same = is_same(i);
    packed.push_back(core::packed(attributes));
  }
  return toArray(packed);
}

/// Which recording of a file: none of a bag, which is one; its number, from 0, of an event log.
using InLog = std::optional<std::size_t>;

/// The event log that was opened last: programs read its recordings in turn, and each would read
/// the index of all again.
std::shared_ptr<const ros1::EventLogFile> openLog(const std::string& path) {
  using Identity = std::tuple<std::string, dev_t, ino_t, off_t, time_t, std::int64_t>;
  struct Opened {
    Identity identity;
    std::shared_ptr<const ros1::EventLogFile> file;
  };
  static Opened last;  // who calls holds Python's lock
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) {
    return ros1::openEventLog(path);  // says what is wrong
  }
  const Identity identity{path,           status.st_dev,         status.st_ino,
                          status.st_size, status.st_mtim.tv_sec, status.st_mtim.tv_nsec};
  if (!last.file || last.identity != identity) {
    last = {identity, ros1::openEventLog(path)};
  }
  return last.file;
}

ros1::BagSummary summaryOf(const Files& files, const InLog& recording) {
  const std::vector<std::string> paths = pathsOf(files);
  return recording ? ros1::EventLogReader(openLog(paths.front()), *recording).summary()
                   : ros1::BagReader(paths).summary();
}

RecordedEvents readEvents(const Files& files, const ros1::EncodingRules& rules,
                          const std::vector<core::EventType>& known, std::optional<double> start,
                          std::optional<double> end, const py::object& progress,
                          const InLog& recording) {
  const ros1::TimeRange range = timeRange(start, end);
  core::Vocabulary vocabulary(known);
  const ros1::EventIds ids = [&](const core::EventType& type) {
    return ros1::internUpTo(known.size() + ros1::kMostEventTypes, type, vocabulary);
  };
  const std::vector<std::string> paths = pathsOf(files);
  RecordedEvents events;
  const auto handler = [&](const core::Event& event) {
    events.stamps.push_back(event.stamp);
    events.ids.push_back(event.id);
    events.attributes.push_back(core::packed(event.attributes));
  };
  const auto onSenders = [&](std::int64_t stamp, const core::Senders& senders) {
    events.senders.emplace_back(stamp, senders.doubled, senders.played);
  };
  if (recording) {
    const ros1::EventLogReader reader(openLog(paths.front()), *recording);
    events.summary = reader.summary();
    reader.read(rules, ids, range, handler, progressTo(progress), [&](const core::Waiting& each) {
      events.waiting.emplace_back(each.from, each.to, each.waited);
    });
    const ros1::Encoder encoder(rules, nullptr);
    ros1::forEachGraph(reader.summary().graph_changes,
                       [&](std::int64_t stamp, const ros1::Graph& graph) {
                         onSenders(stamp, {{}, ros1::playedIn(graph, encoder)});
                       });
  } else {
    const ros1::BagReader reader(paths, progressTo(progress));
    events.summary = reader.summary();
    events.stamps.reserve(events.summary.messages);
    events.ids.reserve(events.summary.messages);
    events.attributes.reserve(events.summary.messages);
    reader.read(ros1::Encoder(rules, ids), range, handler, progressTo(progress), onSenders);
  }
  events.event_types = vocabulary.types();
  return events;
}

void bindBags(py::module& m) {
  py::register_exception<ros1::BagError>(m, "BagError", PyExc_RuntimeError);

  py::class_<ros1::BagSummary>(m, "BagSummary", "What is known of a recording without its events.")
      .def_readonly("bag", &ros1::BagSummary::bag,
                    "file name; of an event log, that of the bag that it was made of")
      .def_property_readonly(
          "files",
          [](const ros1::BagSummary& self) {
            std::vector<std::pair<std::string, std::int64_t>> files;
            for (const ros1::BagSummary::File& file : self.files) {
              files.emplace_back(file.path, file.start);
            }
            return files;
          },
          "of a bag: path and stamp of the first message [ns] of each file, in their order")
      .def_readonly("start", &ros1::BagSummary::start,
                    "stamp of the first message, or when listening began [ns]")
      .def_readonly("end", &ros1::BagSummary::end,
                    "stamp of the last message, or when listening ended [ns]")
      .def_readonly("messages", &ros1::BagSummary::messages, "of an event log: events")
      .def_readonly("fingerprint", &ros1::BagSummary::fingerprint)
      .def_readonly("has_sources", &ros1::BagSummary::has_sources)
      .def_readonly("one_sender_a_topic", &ros1::BagSummary::one_sender_a_topic,
                    "Python's rosbag wrote it; further senders are under the name of the first")
      .def_readonly("copied", &ros1::BagSummary::copied,
                    "the same of a recording: by rosbag filter, compress or decompress")
      .def_readonly("clock_watched", &ros1::BagSummary::clock_watched,
                    "of an event log that was heard live: it ended when ROS time was set")
      .def_property_readonly(
          "set_back",
          [](const ros1::BagSummary& self) {
            std::vector<std::pair<std::int64_t, std::int64_t>> steps;
            for (const ros1::SetBack& step : self.set_back) {
              steps.emplace_back(step.stamp, step.by);
            }
            return steps;
          },
          "of a bag: where the clock was set back, as (stamp of the next message, by how much)\n"
          "[ns]; stamps go on as if it had not been")
      .def_readonly("left_out", &ros1::BagSummary::left_out,
                    "of a bag: why some connections are no events, whatever the encoding")
      .def_property_readonly("encoding", copyOf<ros1::BagSummary>(&ros1::BagSummary::encoding),
                             "a copy of that of an event log; None: a bag")
      .def_readonly("robot_start", &ros1::BagSummary::robot_start, "[ns]; 0: not known")
      .def_readonly("robot", &ros1::BagSummary::robot, "its name; empty: not known")
      .def_readonly("dropped", &ros1::BagSummary::dropped,
                    "messages that came too fast for an event log")
      .def_property_readonly(
          "graph",
          [](const ros1::BagSummary& self) {
            std::map<std::string, std::set<std::string>> publishers;
            std::map<std::string, std::set<std::string>> subscribers;
            for (const auto& [name, topic] : self.graph.topics) {
              publishers[name] = topic.publishers;
              subscribers[name] = topic.subscribers;
            }
            return std::make_tuple(publishers, subscribers, self.graph.hosts);
          },
          "of an event log: publishers and subscribers, each a dict of sets of nodes by topic,\n"
          "and computers by node");
  m.def(
      "lasting_subscriptions", &ros1::lastingSubscriptions, py::arg("summary"),
      py::arg("encoding"),
      "What nodes subscribed to all the time after the start, by the BagSummary of an event log:\n"
      "set of (node, topic); empty of what was not heard live.");
  m.def(
      "missing_subscriptions",
      [](const ros1::BagSummary& summary, const ros1::EncodingRules& encoding,
         const std::set<core::SourceGraph::Subscription>& expected) {
        const ros1::Encoder encoder(encoding, nullptr);
        MissingStates missing;
        ros1::forEachGraph(
            summary.graph_changes, [&](std::int64_t stamp, const ros1::Graph& graph) {
              missing.emplace_back(stamp, ros1::missingIn(graph, encoder, expected));
            });
        return missing;
      },
      py::arg("summary"), py::arg("encoding"), py::arg("expected"),
      "Which of these (TrainedModel.subscriptions) are missing from a time [ns] on each,\n"
      "although the node runs, by the BagSummary of an event log; empty of a bag.");
  m.def("summarise_bag", &summaryOf, py::arg("path"), py::arg("recording") = py::none(),
        "BagSummary of a bag, or of a recording in an event log (see read_events). Raises "
        "BagError.");
  m.def(
      "bag_span",
      [](const std::string& path) {
        const ros1::BagSpan span = ros1::spanOfBag(path);
        return span.messages == 0 ? std::nullopt
                                  : std::optional(std::make_pair(span.start, span.end));
      },
      py::arg("path"),
      "Stamps of a bag's first and last message [ns]; None: it is empty. Takes no time even\n"
      "where the bag is large, and finds not every damage. Raises BagError.");
  m.def(
      "name_of_files", [](const Files& files) { return ros1::nameOf(pathsOf(files)); },
      py::arg("files"),
      "What a recording is called by its files: 'run_0.bag', 'run_0.bag..4' of five.");
  m.def(
      "recorded_types",
      [](const Files& path, const ros1::EncodingRules& encoding, const InLog& recording) {
        return recording ? ros1::EventLogReader(openLog(pathsOf(path).front()), *recording)
                               .eventTypes(encoding)
                         : ros1::eventTypesIn(pathsOf(path), ros1::Encoder(encoding, nullptr));
      },
      py::arg("path"), py::arg("encoding"), py::arg("recording") = py::none(),
      "The event types of a recording, without reading its events: of a bag without values of\n"
      "fields. BagError as read_events().");
  m.def("recordings_in_event_log", &ros1::recordingsInEventLog, py::arg("path"),
        "Number of recordings in an event log; None: it is none, or cannot be read.");
  m.def(
      "last_log_lines",
      [](const Files& path, const ros1::EncodingRules& encoding,
         const std::vector<std::pair<std::string, std::int64_t>>& nodes, std::size_t most) {
        std::vector<ros1::LogQuery> queries;
        for (const auto& [node, until] : nodes) {
          queries.push_back({node, until});
        }
        std::vector<std::vector<std::tuple<std::int64_t, int, std::string>>> found;
        for (const std::vector<ros1::LogLine>& lines :
             ros1::lastLogLines(pathsOf(path), ros1::Encoder(encoding, nullptr), queries, most)) {
          found.emplace_back();
          for (const ros1::LogLine& line : lines) {
            found.back().emplace_back(line.stamp, line.level, line.text);
          }
        }
        return found;
      },
      py::arg("path"), py::arg("encoding"), py::arg("nodes"), py::arg("most"),
      "The last lines that nodes wrote to /rosout, of each pair of a node, as events call it,\n"
      "and a time [ns] up to that time: (stamp [ns], level as in rosgraph_msgs/Log, text).\n"
      "Raises BagError.");

  py::class_<RecordedEvents>(m, "RecordedEvents", "The events of a recording, in memory.")
      .def_readonly("summary", &RecordedEvents::summary)
      .def_readonly("event_types", &RecordedEvents::event_types, "by id")
      .def_property_readonly("stamps", viewOf(&RecordedEvents::stamps), "int64 [ns], read-only")
      .def_property_readonly("ids", viewOf(&RecordedEvents::ids), "uint32, read-only")
      .def_property_readonly("attributes", viewOf(&RecordedEvents::attributes),
                             "of the messages, uint32, read-only: pack_attributes(); 0: not known")
      .def_readonly(
          "waiting", &RecordedEvents::waiting,
          "how the machine was: of each stretch of time (begin, end, how long processes\n"
          "waited for a processor in it) [ns]; empty: not known")
      .def_readonly(
          "senders", &RecordedEvents::senders,
          "who sends, from a time [ns] on each: what comes from two senders of one name,\n"
          "a set of (source, topic), and what players play, a set of EventType");
  m.def(
      "read_numbers",
      [](const Files& path, const ros1::EncodingRules& encoding, std::optional<double> start,
         std::optional<double> end) {
        std::map<std::string, py::array_t<double>> arrays;
        for (const auto& [datatype, numbers] :
             ros1::BagReader(pathsOf(path)).readNumbers(encoding, timeRange(start, end))) {
          arrays[datatype] = toArray(numbers);
        }
        return arrays;
      },
      py::arg("path"), py::arg("encoding"), py::arg("start") = py::none(),
      py::arg("end") = py::none(),
      "The values in a bag of the fields that the encoding has classes for, by datatype; NaN: no\n"
      "number. start, end: as for read_events(). Raises BagError.");
  m.def(
      "read_events", &readEvents, py::arg("path"), py::arg("encoding"),
      py::arg("event_types") = std::vector<core::EventType>(), py::arg("start") = py::none(),
      py::arg("end") = py::none(), py::arg("progress") = py::none(),
      py::arg("recording") = py::none(),
      "RecordedEvents of a bag: stamps (int64 [ns]) and ids (uint32). Ids below len(event_types)\n"
      "stand for these, the ids after them for new types. start, end: seconds from the\n"
      "recording's first message. Calls progress(done, all) from time to time.\n"
      "recording: its number in an event log, from 0; None: the file is a bag.\n"
      "path: of a file, or of the files of one recording, in their order. Raises BagError.");
}

/// Reads an attribute of an object of Python.
/// @throw pybind11::type_error names it if it has another type
template <typename T>
void take(const py::object& recording, const char* name, T& value) {
  try {
    value = recording.attr(name).cast<T>();
  } catch (const py::cast_error&) {
    throw py::type_error(std::string("a recording has a wrong type: ") + name);
  }
}

}  // namespace

RecordingEvents::RecordingEvents(const py::object& from) {
  std::vector<std::int64_t> clock_steps;
  std::vector<WaitingState> waiting;
  take(from, "event_types", event_types);
  take(from, "stamps", stamps);
  take(from, "ids", ids);
  take(from, "end", end);
  take(from, "fingerprint", recording.fingerprint);
  take(from, "bag", recording.name);
  take(from, "robot", recording.robot);
  take(from, "robot_start", recording.robot_start);
  take(from, "clock_steps", clock_steps);
  take(from, "attributes", attributes);
  take(from, "waiting", waiting);
  take(from, "senders", senders);
  take(from, "missing", missing);
  take(from, "hosts", hosts);
  take(from, "before", before);
  recording.clock_steps = core::ClockSteps(std::move(clock_steps));
  for (const auto& [begin, end_of_it, waited] : waiting) {
    recording.waiting.push_back({begin, end_of_it, waited});
  }
}

void bindRecordings(py::module& m) {
  m.def(
      "find_clock_steps",
      [](const Stamps& stamps, const Ids& ids) {
        std::vector<core::Event> events;
        events.reserve(static_cast<std::size_t>(stamps.size()));
        forEachEvent(stamps, ids, {}, [&](const core::Event& event) { events.push_back(event); });
        return core::findClockSteps(events);
      },
      py::arg("stamps"), py::arg("ids"),
      "Where the clock was set forward: stamps of the first event after each step [ns].");
  m.def("pack_attributes", &packAttributes, py::arg("ages"), py::arg("sizes"), py::arg("steps"),
        py::arg("same"),
        "The attributes of messages, each as one number, uint32 (docs/method.md, section 3.10).\n"
        "ages: since their stamps [s], NaN: there is no header, inf: the stamp is 0; sizes:\n"
        "[bytes]; steps: of their numbers (header.seq) since the message before, -1: not known;\n"
        "same: the bytes behind the header are those of the message before.");
  bindBags(m);
}

}  // namespace self_awareness::python
