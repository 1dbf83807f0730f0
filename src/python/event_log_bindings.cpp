#include <pybind11/stl.h>

#include <map>
#include <memory>
#include <set>
#include <string>

#include "bindings.h"
#include "self_awareness/ros/bag/bag_reader.h"
#include "self_awareness/ros/bag/event_log_writer.h"
#include "self_awareness/ros/graph.h"
#include "self_awareness/ros/own_output.h"

namespace self_awareness::python {
namespace {

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
