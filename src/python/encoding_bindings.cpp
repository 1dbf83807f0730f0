#include <pybind11/stl.h>
#include <ros/serialization.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bindings.h"
#include "ros/check.h"
#include "ros/text.h"
#include "self_awareness/Encoding.h"
#include "self_awareness/core/stream/listed.h"
#include "self_awareness/core/stream/mode.h"
#include "self_awareness/ros/bag/bag_reader.h"
#include "self_awareness/ros/bag/event_log_writer.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/encoding_message.h"
#include "self_awareness/ros/graph.h"
#include "self_awareness/ros/own_output.h"
#include "self_awareness/ros/stable_name.h"

namespace self_awareness::python {
namespace {

using EventTypeState = std::tuple<std::string, std::string, std::string>;
using RenameState = std::pair<std::string, std::string>;
using ModeState = std::pair<std::string, std::string>;  // topic, field
using ClassesState = std::map<std::string, std::pair<std::size_t, std::vector<double>>>;

std::vector<RenameState> renamesOf(const ros1::EncodingRules& rules) {
  std::vector<RenameState> renames;
  for (const ros1::Rename& rename : rules.renames) {
    renames.emplace_back(rename.pattern, rename.name);
  }
  return renames;
}

void setRenames(ros1::EncodingRules& rules, const std::vector<RenameState>& renames) {
  rules.renames.clear();
  for (const auto& [pattern, name] : renames) {
    rules.renames.push_back({pattern, name});
  }
}

std::optional<ModeState> modeOf(const ros1::EncodingRules& rules) {
  return rules.mode ? std::optional(ModeState(rules.mode->topic, rules.mode->field))
                    : std::nullopt;
}

void setMode(ros1::EncodingRules& rules, const std::optional<ModeState>& mode) {
  rules.mode = mode ? std::optional(ros1::ModeField{mode->first, mode->second}) : std::nullopt;
}

ClassesState classesOf(const ros1::EncodingRules& rules) {
  ClassesState state;
  for (const auto& [datatype, classes] : rules.classes) {
    state[datatype] = {classes.number, classes.bounds};
  }
  return state;
}

void setClasses(ros1::EncodingRules& rules, const ClassesState& state) {
  rules.classes.clear();
  for (const auto& [datatype, classes] : state) {
    rules.classes[datatype] = {classes.first, classes.second};
  }
}

using Names = std::set<std::string>;

template <typename Rename>
std::map<std::string, std::string> namesBy(const Names& names, Rename rename) {
  std::map<std::string, std::string> by;
  for (const std::string& name : names) {
    by[name] = rename(name);
  }
  return by;
}

/// What is pickled: the message that files hold.
py::bytes stateOfRules(const ros1::EncodingRules& rules) {
  const self_awareness::Encoding message = ros1::toMessage(rules);
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

ros1::EncodingRules rulesFrom(const py::bytes& state) {
  const auto bytes = static_cast<std::string>(state);
  return ros1::fromMessage(ros1::readMessage<self_awareness::Encoding>(
      reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()));
}

using NodesOfTopics = std::map<std::string, std::set<std::string>>;

ros1::Graph graphOfNodes(const NodesOfTopics& publishers, const NodesOfTopics& subscribers,
                         const HostsState& hosts) {
  ros1::Graph graph;
  graph.hosts = hosts;
  for (const auto& [topic, nodes] : publishers) {
    graph.topics[topic].publishers = nodes;
  }
  for (const auto& [topic, nodes] : subscribers) {
    graph.topics[topic].subscribers = nodes;
  }
  return graph;
}

}  // namespace

void bindEncoding(py::module& m) {
  m.attr("FEWEST_CLASSES") = ros1::ValueClasses::kFewest;
  m.attr("MOST_CLASSES") = ros1::ValueClasses::kMost;
  m.def("resolved_name", &ros1::resolvedName, py::arg("name"),
        "The whole name of a node or a topic: 'scan' and '//scan' are '/scan'.");
  m.def("stable_name", &ros1::stableName, py::arg("name"),
        "A node's whole name without the number that makes it anonymous.");
  m.def(
      "printable", [](const std::string& text) { return ros1::printable(text); }, py::arg("text"),
      "The text with U+FFFD in place of what controls a terminal, or turns the text around.");
  py::class_<core::EventType>(m, "EventType", "What happened: (source, scope, type).")
      .def(py::init<std::string, std::string, std::string>(), py::arg("source"), py::arg("scope"),
           py::arg("type"))
      .def_readonly("source", &core::EventType::source)
      .def_readonly("scope", &core::EventType::scope)
      .def_readonly("type", &core::EventType::type)
      .def_property_readonly(
          "component",
          [](const core::EventType& self) { return core::componentOf(self.source, self.scope); },
          "who sends it: its source, or its scope where sources are not told apart")
      .def_property_readonly(
          "tells_mode", [](const core::EventType& self) { return core::tellsMode(self); },
          "whether it tells the mode of the robot, and is no message of its own")
      .def_property_readonly(
          "is_message",
          [](const core::EventType& self) {
            return !core::tellsMode(self) && !core::isLatched(self) && !core::tellsList(self);
          },
          "whether its events are messages, not what is told besides")
      .def("__str__", py::overload_cast<const core::EventType&>(&core::toString))
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
      .def(py::init<>(), "Sources told apart, nothing excluded, no type fields, no mode.")
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
      .def_property("rename", &renamesOf, &setRenames,
                    "rules by which names are replaced, as pairs: pattern, and new name")
      .def_readwrite("include_topics", &ros1::EncodingRules::include_topics)
      .def_readwrite("exclude_topics", &ros1::EncodingRules::exclude_topics)
      .def_readwrite("include_sources", &ros1::EncodingRules::include_sources)
      .def_readwrite("exclude_sources", &ros1::EncodingRules::exclude_sources)
      .def_readwrite("type_fields", &ros1::EncodingRules::type_fields)
      .def_property(
          "classes", &classesOf, &setClasses,
          "of the values of type fields, by datatype: how many, and the bounds that were "
          "learned")
      .def_property("mode", &modeOf, &setMode,
                    "what tells the mode of the robot: its topic, and a field of its messages")
      .def(
          "validate", &ros1::EncodingRules::validate,
          "ValueError if a pattern is no regular expression, a new name does not fit one, or the\n"
          "mode's topic is none, or is left out.")
      .def(
          "sources_of",
          [](const ros1::EncodingRules& self, const Names& nodes) {
            const ros1::Encoder encoder(self, nullptr);
            return namesBy(nodes, [&](const std::string& node) { return encoder.sourceOf(node); });
          },
          py::arg("nodes"), "What events call nodes, by their names.")
      .def(
          "scopes_of",
          [](const ros1::EncodingRules& self, const Names& topics) {
            const ros1::Encoder encoder(self, nullptr);
            return namesBy(topics,
                           [&](const std::string& topic) { return encoder.scopeOf(topic); });
          },
          py::arg("topics"), "What events call topics, by their names.")
      .def(
          "includes_source",
          [](const ros1::EncodingRules& self, const std::string& source) {
            return ros1::Encoder(self, nullptr).includesSource(source);
          },
          py::arg("source"), "Whether messages of a node can be events, by its stable name.")
      .def(py::pickle(&stateOfRules, &rulesFrom))
      .def("__eq__",
           [](const ros1::EncodingRules& a, const ros1::EncodingRules& b) { return a == b; });
}

void bindEventLogs(py::module& m) {
  m.def(
      "unheard_publications",
      [](const ros1::EncodingRules& encoding, const NodesOfTopics& publishers,
         const NodesOfTopics& subscribers) {
        return ros1::unheardIn(graphOfNodes(publishers, subscribers, {}),
                               ros1::Encoder(encoding, nullptr));
      },
      py::arg("encoding"), py::arg("publishers"), py::arg("subscribers"),
      "What nodes publish, and the encoding includes, and no node of the robot subscribes to:\n"
      "(source, topic). ValueError for a pattern that is no regular expression.");
  m.def(
      "why_nothing_is_heard",
      [](const ros1::EncodingRules& encoding, const NodesOfTopics& publishers,
         const NodesOfTopics& subscribers, const std::map<std::string, std::string>& types,
         bool used_only) {
        ros1::Graph graph = graphOfNodes(publishers, subscribers, {});
        for (auto& [name, topic] : graph.topics) {
          const auto type = types.find(name);
          topic.datatype = type == types.end() ? "" : type->second;
        }
        return ros1::whyNothingIsHeard(graph, ros1::Encoder(encoding, nullptr), used_only);
      },
      py::arg("encoding"), py::arg("publishers"), py::arg("subscribers"), py::arg("types"),
      py::arg("used_only"),
      "Why nothing of a robot is heard, in words. types: by topic; used_only: whether only what\n"
      "a node of the robot subscribes to is listened to.");
  m.def(
      "host_in", &ros1::hostIn, py::arg("uri"),
      "The name or the address in the URI of a node's XML-RPC server, printable; empty: there is "
      "none.");
  m.def("is_own_type", &ros1::isOwnType, py::arg("datatype"),
        "Whether messages of this type come from a node of this package.");
  py::class_<ros1::EventLogWriter>(m, "EventLogWriter", "Writes an event log.")
      .def(py::init<const std::string&, const std::string&>(), py::arg("path"),
           py::arg("named") = "",
           "Replaces a file that is there. named: what errors call the file, if not by its path.")
      .def(
          "add_bag",
          [](ros1::EventLogWriter& self, const Files& path, const ros1::EncodingRules& encoding,
             const NodesOfTopics& publishers, const NodesOfTopics& subscribers,
             const HostsState& hosts, const py::object& progress) {
            const ros1::BagReader bag(pathsOf(path));
            ros1::addToEventLog(bag, encoding, graphOfNodes(publishers, subscribers, hosts), self,
                                progressTo(progress));
            return bag.summary();
          },
          py::arg("path"), py::arg("encoding"), py::arg("publishers") = NodesOfTopics(),
          py::arg("subscribers") = NodesOfTopics(), py::arg("hosts") = HostsState(),
          py::arg("progress") = py::none(),
          "Adds a bag, or the files of one recording, as a recording of its own, with the nodes\n"
          "of its topics and their computers where they are known; returns its BagSummary. After\n"
          "an error the log is of no use.")
      .def("close", &ros1::EventLogWriter::close, "Ends the file; without that it has no index.");
}

}  // namespace self_awareness::python
