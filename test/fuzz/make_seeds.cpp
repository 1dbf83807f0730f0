// Writes the inputs that the fuzzers begin with: fuzz_seeds FOLDER. They are small and made here;
// no recording is among them.

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <visualization_msgs/Marker.h>

#include <boost/filesystem.hpp>
#include <iostream>
#include <string>
#include <utility>

#include "bag_bytes.h"
#include "ros/verdict/kept_files.h"
#include "self_awareness/EventLogGraph.h"
#include "self_awareness/core/learn.h"
#include "self_awareness/ros/bag/bag_reader.h"
#include "self_awareness/ros/bag/event_log_writer.h"
#include "self_awareness/ros/model/model_file.h"

namespace fs = boost::filesystem;
using namespace self_awareness;  // NOLINT
using ros1::bag_bytes::block;

namespace {

std::string folderOf(const std::string& root, const std::string& fuzzer) {
  const fs::path folder = fs::path(root) / fuzzer;
  fs::create_directories(folder);
  return folder.string() + "/";
}

/// The same bag without compression, which fuzzers see through, and with each kind of it.
void writeAllCompressions(const std::string& bag, const std::string& prefix) {
  const rosbag::Bag whole(bag, rosbag::bagmode::Read);
  for (const auto& [name, compression] :
       {std::pair{"none", rosbag::compression::Uncompressed},
        std::pair{"lz4", rosbag::compression::LZ4}, std::pair{"bz2", rosbag::compression::BZ2}}) {
    rosbag::Bag copy(prefix + name, rosbag::bagmode::Write);
    copy.setCompression(compression);
    for (const rosbag::MessageInstance& message : rosbag::View(whole)) {
      copy.write(message.getTopic(), message.getTime(), message, message.getConnectionHeader());
    }
  }
}

ros1::bag_bytes::Parts smallBag() {
  ros1::bag_bytes::Parts parts;
  for (std::uint32_t k = 0; k < 10; ++k) {
    parts.messages.emplace_back(100 + k, block(std::string(k % 3, 'x')));
  }
  return parts;
}

/// A model of two event types for both detectors, with limits.
void writeModel(const std::string& path) {
  core::Learner::Parameters parameters;
  parameters.counting.paper = true;
  core::SourceGraph graph;
  graph.connect("/a", "/x", "/b");
  core::Learner learner(parameters, graph);
  const core::EventId a = learner.intern({"/a", "/x", "T"});
  const core::EventId b = learner.intern({"/b", "/y", "T[action=1]"});
  for (std::uint64_t number = 0; number < 2; ++number) {
    core::Recording recording;
    for (int i = 0; i < 150; ++i) {
      recording.events.push_back({i * 37000000LL, i % 3 == 0 ? b : a});
    }
    learner.count(recording);
  }
  ros1::TrainedModel model(learner.counts());
  model.encoding = ros1::EncodingRules::defaults();
  model.watch();
  model.stamp = core::kNanosecondsPerSecond;
  model.paper_calibration = core::paper::Calibration();
  model.paper_calibration->threshold = 1.25;
  model.calibration = core::Calibration();
  model.calibration->limits.tracks.assign(model.watched.tracks.size(), 2.5);
  ros1::saveModel(model, path);
}

void writeBags(const std::string& folder) {
  ros1::bag_bytes::Parts parts = smallBag();
  ros1::bag_bytes::writeFile(folder + "small", parts.bag());
  writeAllCompressions(folder + "small", folder + "small_");
  const std::string data = parts.chunk();
  const std::string chunk =
      parts.chunkRecord(data, static_cast<std::uint32_t>(data.size())) + parts.indexRecord();
  ros1::bag_bytes::writeFile(folder + "two_chunks", parts.bag({chunk, chunk}));
}

void writeEventLogs(const std::string& folder) {
  ros1::bag_bytes::writeFile(folder + "bag", smallBag().bag());
  {
    ros1::EventLogWriter log(folder + "log");
    ros1::Graph graph;
    graph.topics["/a"] = {"std_msgs/String", {"/node"}, {"/other"}};
    ros1::EncodingRules rules;
    rules.type_fields = {{"std_msgs/String", "data"}};
    for (int recording = 0; recording < 2; ++recording) {
      ros1::addToEventLog(ros1::BagReader(folder + "bag"), rules, graph, log);
    }
    log.close();
  }
  writeAllCompressions(folder + "log", folder + "log_");
}

void writeStandingAlarm(const std::string& folder) {
  self_awareness::StandingAlarm standing;
  standing.alarm.level = self_awareness::SelfAwareness::ERROR;
  standing.alarm.alarm = 1;
  standing.alarm.kind = core::toString(core::Kind::kSilent);
  standing.alarm.suspects.resize(1);
  standing.alarm.suspects[0].source = "/node";
  standing.alarm.suspects[0].scope = "/topic";
  standing.alarm.suspects[0].type = "T";
  standing.alarm.suspects[0].kind = standing.alarm.kind;
  ros1::writeStandingAlarm(standing, folder + "alarm");
  writeAllCompressions(folder + "alarm", folder + "alarm_");
}

template <typename Message>
std::string serialized(const Message& message) {
  std::string bytes(ros::serialization::serializationLength(message), '\0');
  ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(&bytes[0]),
                                     static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

void writeMessages(const std::string& folder) {
  namespace traits = ros::message_traits;
  visualization_msgs::Marker marker;
  marker.header.frame_id = "map";
  marker.points.resize(2);
  marker.text = "Ada";
  ros1::bag_bytes::writeFile(folder + "marker", traits::definition<visualization_msgs::Marker>() +
                                                    ('\0' + serialized(marker)));
  for (const auto& [name, definition] :
       {std::pair{"ring", "visualization_msgs/Marker self\nint32 action\n"},
        std::pair{"long", "string[4294967295] x\nuint8[99999999999999999999] y\nint32 action\n"},
        std::pair{"arrays",
                  "string[] x\nfloat64[3] y\nHeader[] z\nint32 action\n====\n"
                  "MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"}}) {
    ros1::bag_bytes::writeFile(folder + name, definition + std::string(40, '\0'));
  }
}

/// The start of an event log and a graph, as this version and as others lay them out.
void writeStored(const std::string& folder) {
  namespace traits = ros::message_traits;
  const self_awareness::EventLogStart start =
      ros1::startOfRecording(ros1::EncodingRules::defaults(), core::kNanosecondsPerSecond);
  const std::string bytes = '\0' + serialized(start);
  const std::string definition = traits::definition<self_awareness::EventLogStart>();
  ros1::bag_bytes::writeFile(folder + "start", definition + bytes);
  for (const char* name : {"uint64 fingerprint", "uint8 classes", "string pattern"}) {
    std::string other = definition;
    const std::size_t at = other.find(name);
    if (at != std::string::npos) {
      ros1::bag_bytes::writeFile(folder + "renamed_" + std::to_string(at),
                                 other.insert(other.find(' ', at) + 1, "other_") + bytes);
    }
  }
  self_awareness::EventLogGraph graph;
  graph.topics.resize(2);
  graph.topics[0].publishers = {"/a", "/b"};
  ros1::bag_bytes::writeFile(
      folder + "graph",
      traits::definition<self_awareness::EventLogGraph>() + ('\0' + serialized(graph)));
}

void writeEncodings(const std::string& folder) {
  std::string lines;
  const ros1::EncodingRules rules = ros1::EncodingRules::defaults();
  for (const auto* patterns : {&rules.exclude_topics, &rules.exclude_sources}) {
    for (const std::string& pattern : *patterns) {
      lines += pattern + '\n';
    }
  }
  ros1::bag_bytes::writeFile(folder + "defaults", lines + "/ns/play_1795206538727453261\n");
  ros1::bag_bytes::writeFile(folder + "nested", "(([a-z/_])*)*#\n" + std::string(300, 'a'));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: fuzz_seeds FOLDER\n";
    return 2;
  }
  writeBags(folderOf(argv[1], "bag"));
  writeEventLogs(folderOf(argv[1], "event_log"));
  writeMessages(folderOf(argv[1], "message_field"));
  writeEncodings(folderOf(argv[1], "encoding"));
  const std::string models = folderOf(argv[1], "model");
  writeModel(models + "model");
  writeAllCompressions(models + "model", models + "model_");
  writeStandingAlarm(folderOf(argv[1], "standing_alarm"));
  writeStored(folderOf(argv[1], "message_upgrade"));
  return 0;
}
