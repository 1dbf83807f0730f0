#include "self_awareness/ros/model/model_file.h"

#include <rosbag/bag.h>
#include <rosbag/exceptions.h>

#include <algorithm>
#include <boost/filesystem/operations.hpp>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <utility>

#include "../bag/bag_index.h"
#include "../bag/stored_messages.h"
#include "../bag/version_of_bag.h"
#include "../text.h"
#include "check.h"
#include "model_upgrade.h"
#include "packed_pairs.h"
#include "self_awareness/ContentDigest.h"
#include "self_awareness/ros/bag/bag_reader.h"
#include "self_awareness/ros/bag/bag_writer.h"
#include "self_awareness/ros/encoding_message.h"
#include "self_awareness/ros/graph.h"
#include "self_awareness/ros/model/calibration_message.h"
#include "self_awareness/ros/model/delays_message.h"
#include "self_awareness/ros/model/evidence_message.h"
#include "self_awareness/ros/model/tuning_message.h"
#include "self_awareness/ros/output_file.h"
#include "self_awareness/ros/ros_time.h"

namespace self_awareness::ros1 {
namespace {

constexpr char kTopic[] = "/model";
constexpr char kDelaysTopic[] = "/delays";
constexpr char kDigestTopic[] = "/digest";
constexpr std::array<const char*, 2> kEvidenceTopics{"/evidence/first", "/evidence/second"};

constexpr std::uint32_t kFirstPacked = 3;  // format with PackedPairs; before, EvidencePairs

// Of a file that may be made to fill the memory: many times what the largest model needs.
constexpr std::uint64_t kLargestChunk = 1 << 28;  // [bytes]
constexpr std::size_t kMostTracks = 200000;

constexpr char kOtherDelays[] = "its histograms do not fit its event types";
constexpr char kOtherEvidence[] = "its evidence does not fit its event types";

self_awareness::GraphEdge graphMessage(const core::SourceGraph::Edge& edge) {
  self_awareness::GraphEdge message;
  message.publisher = edge.publisher;
  message.topic = edge.topic;
  message.subscriber = edge.subscriber;
  return message;
}

core::paper::DelayStatistics eventTypesOf(const self_awareness::Model& message) {
  core::paper::DelayStatistics statistics(
      core::paper::Binning{message.bin_size, message.horizon_bins});
  for (const self_awareness::EventType& type : message.event_types) {
    const std::size_t before = statistics.vocabulary().size();
    const core::EventId id = statistics.intern({type.source, type.scope, type.type});
    check(id == before, "an event type occurs twice");
    statistics.countEvent(id, type.count);
  }
  check(statistics.events() > 0, "it was trained on no event");
  return statistics;
}

void checkEffort(const self_awareness::Model& message) {
  check(message.window.toNSec() >= core::kShortestWindow &&
            message.window.toNSec() <= core::kLongestWindow,
        "the length of its windows cannot be");
  check(message.event_types.size() <= kMostEventTypes, "it has too many event types");
  check(message.tracks.size() <= kMostTracks, "it watches too much");
  check(message.graph.size() <= kMostEdges, "it has too many edges");
  std::size_t unheard = 0;
  for (const self_awareness::TopicNodes& topic : message.unheard) {
    unheard += topic.publishers.size();
  }
  check(unheard <= kMostEdges, "it has too many topics that nobody subscribed to");
  check(message.subscriptions.size() <= kMostEdges, "it has too many subscriptions");
  check(message.hosts.size() <= kMostHosts, "it has too many computers of sources");
}

/// The messages of a model file.
class ModelMessages {
 public:
  explicit ModelMessages(std::string path) : path_(std::move(path)) {
    std::optional<BagIndex> index = readIndexOfFormat2(path_);
    if (!index) {
      throw ModelFileError(path_ + ": not a model file");
    }
    index_ = std::move(*index);
    messages_ = std::make_unique<StoredMessages>(path_, index_, kLargestChunk);
    readDigests();
  }

  /// @throw BagError as checkedVersion()
  self_awareness::FileVersion version() {
    self_awareness::FileVersion version = checkedVersion(path_, index_, kModelFile);
    forEach<self_awareness::FileVersion>(kVersionTopic, [](const auto& /*checked*/) {});
    return version;
  }

  /// Calls visit(message) for every message on a topic; returns their number.
  /// @throw std::invalid_argument if one is damaged, or they are not what was written
  template <typename Message, typename Visit>
  std::size_t forEach(const std::string& topic, Visit visit) {
    std::size_t number = 0;
    ContentDigest digest;
    for (const BagIndexEntry& entry : index_.entries) {
      const Connection& connection = index_.connections[entry.connection];
      if (connection.topic == topic && holds<Message>(connection)) {
        visit(messages_->read<Message>(entry, &digest));
        ++number;
      }
    }
    const auto known = digests_.find(topic);
    check(known == digests_.end() ? digests_.empty() || number == 0
                                  : known->second == digest.value(),
          "its content is not what was written: its digest is another one");
    return number;
  }

  const std::string& path() const { return path_; }

 private:
  void readDigests() {
    std::map<std::string, std::uint64_t> found;
    forEach<self_awareness::ContentDigest>(
        kDigestTopic, [&](const self_awareness::ContentDigest& message) {
          check(message.topics.size() == message.digests.size() && !message.topics.empty(),
                "its digest is none");
          for (std::size_t k = 0; k < message.topics.size(); ++k) {
            check(found.emplace(message.topics[k], message.digests[k]).second,
                  "it holds a digest twice");
          }
        });
    digests_ = std::move(found);
  }

  std::string path_;
  BagIndex index_;
  std::unique_ptr<StoredMessages> messages_;
  std::map<std::string, std::uint64_t> digests_;  // by topic; none: the file is of before
};

TrainedModel read(ModelMessages& messages, ModelCounts counts) {
  const self_awareness::FileVersion version = messages.version();
  std::optional<TrainedModel> model;
  const std::size_t models =
      messages.forEach<self_awareness::Model>(kTopic, [&](self_awareness::Model message) {
        checkEffort(message);
        if (const std::string twice = resolveNames(message); !twice.empty()) {
          throw ModelFileError(messages.path() + ": it knows the topic " + printable(twice) +
                               " twice, with and without a slash too many or too few, as earlier "
                               "versions took them from bags; train it again");
        }
        std::set<std::string> left_out = upgrade(message, version.format);
        model = fromMessage(message);
        model->version = version;
        model->left_out = std::move(left_out);
      });
  check(models <= 1, "it holds more than one model");
  if (!model) {
    throw ModelFileError(messages.path() +
                         ": a bag, but it holds no model; train one from it "
                         "(rosrun self_awareness train)");
  }
  if (counts != ModelCounts::kWatched || !model->isWatched()) {
    const std::size_t number = messages.forEach<self_awareness::DelayHistograms>(
        kDelaysTopic,
        [&, next = core::EventId{0}](const self_awareness::DelayHistograms& message) mutable {
          check(message.to_id == next++, kOtherDelays);
          addMessage(message, model->statistics);
        });
    check(number == model->vocabulary().size() || (number == 0 && model->isWatched()),
          kOtherDelays);
  }
  const std::size_t halves = counts == ModelCounts::kAll && model->isWatched() ? 2 : 0;
  for (std::size_t half = 0; half < halves; ++half) {
    model->evidence.at(half) = model->watched.halves.at(half).withoutPairs();
    const auto set = [&, next = core::EventId{0}](const auto& message) mutable {
      check(message.id == next++, kOtherEvidence);
      setPairs(message, model->evidence.at(half));
    };
    const std::string topic = kEvidenceTopics.at(half);
    const std::size_t number = version.format < kFirstPacked
                                   ? messages.forEach<self_awareness::EvidencePairs>(topic, set)
                                   : messages.forEach<self_awareness::PackedPairs>(topic, set);
    check(number == model->vocabulary().size(), kOtherEvidence);
  }
  return std::move(*model);
}

/// Writes the messages of a model file.
class ModelWriter {
 public:
  ModelWriter(BagWriter& bag, std::int64_t stamp)
      // A bag cannot hold a message with the time 0.
      : bag_(bag), stamp_(std::max(toRosTime(stamp), ros::TIME_MIN)) {}

  template <typename Message>
  void write(const std::string& topic, const Message& message) {
    bag_.write({topic}, stamp_, message);
    digests_[topic].add(bag_.written().data(), bag_.written().size());
  }
  const std::vector<std::uint8_t>& written() const { return bag_.written(); }
  /// Writes the digest of all before it.
  void writeDigests() {
    self_awareness::ContentDigest message;
    for (const auto& [topic, digest] : digests_) {
      message.topics.push_back(topic);
      message.digests.push_back(digest.value());
    }
    bag_.write({kDigestTopic}, stamp_, message);
  }

 private:
  BagWriter& bag_;
  ros::Time stamp_;
  std::map<std::string, ContentDigest> digests_;  // by topic
};

void write(const TrainedModel& model, ModelWriter& file) {
  self_awareness::FileVersion version = versionOf(kModelFile);
  version.method = model.version.method;
  file.write(kVersionTopic, version);
  file.write(kTopic, toMessage(model));
  // A file that nobody could read would be found out when it is needed.
  fromMessage(readMessage<self_awareness::Model>(file.written().data(), file.written().size()));
  for (core::EventId id = 0; id < model.vocabulary().size(); ++id) {
    if (model.hasDelays()) {
      file.write(kDelaysTopic, toMessage(model.statistics, id));
    }
    for (std::size_t half = 0; model.hasEvidence() && half < model.evidence.size(); ++half) {
      file.write(kEvidenceTopics.at(half), packedPairs(model.evidence.at(half), id));
    }
  }
  file.writeDigests();
}

}  // namespace

self_awareness::Model toMessage(const TrainedModel& model) {
  self_awareness::Model message;
  message.stamp = toRosTime(model.stamp);
  message.encoding = toMessage(model.encoding);
  message.window.fromNSec(model.window);
  message.bin_size = model.statistics.binning().bin_size;
  message.horizon_bins = model.statistics.binning().horizon_bins;
  for (core::EventId id = 0; id < model.statistics.vocabulary().size(); ++id) {
    const core::EventType& type = model.statistics.vocabulary().at(id);
    self_awareness::EventType event_type;
    event_type.source = type.source;
    event_type.scope = type.scope;
    event_type.type = type.type;
    event_type.count = model.statistics.eventCount(id);
    message.event_types.push_back(event_type);
  }
  message.tuning = toMessage(model.tuning);
  for (const core::evidence::Track& track : model.watched.tracks) {
    message.tracks.push_back(toMessage(track));
  }
  if (model.isWatched()) {
    for (const core::evidence::Statistics& half : model.watched.halves) {
      message.watched.push_back(toMessage(half));
    }
  }
  for (const core::SourceGraph::Edge& edge : model.graph.edges()) {
    message.graph.push_back(graphMessage(edge));
  }
  for (const auto& [source, host] : model.graph.hosts()) {
    self_awareness::NodeHost& placed = message.hosts.emplace_back();
    placed.node = source;
    placed.host = host;
  }
  for (const auto& [subscription, recordings] : model.graph.lasting()) {
    self_awareness::Subscription& lasting = message.subscriptions.emplace_back();
    lasting.node = subscription.first;
    lasting.topic = subscription.second;
    lasting.recordings = static_cast<std::uint32_t>(recordings);
  }
  for (const auto& [source, topic] : model.graph.unheard()) {
    self_awareness::TopicNodes& unheard = message.unheard.emplace_back();
    unheard.topic = topic;
    unheard.publishers = {source};
  }
  message.recordings = toMessages(model.recordings);
  for (const core::evidence::LimitFinder::Recording& recording : model.findings) {
    message.findings.push_back(toMessage(recording));
  }
  if (model.paper_calibration) {
    message.calibration.push_back(toMessage(*model.paper_calibration));
  }
  if (model.calibration) {
    message.evidence_calibration.push_back(toMessage(*model.calibration));
  }
  return message;
}

TrainedModel fromMessage(const self_awareness::Model& message) {
  checkEffort(message);
  TrainedModel model;
  model.stamp = fromRosTime(message.stamp);
  model.encoding = fromMessage(message.encoding);
  model.window = message.window.toNSec();
  model.statistics = eventTypesOf(message);
  model.tuning = tuningOf(message);
  model.watched.tuning = model.tuning;
  for (const self_awareness::Track& track : message.tracks) {
    model.watched.tracks.push_back(fromMessage(track));
  }
  check(message.watched.size() == model.watched.halves.size() ||
            (message.watched.empty() && message.tracks.empty()),
        "its evidence has not two halves");
  std::transform(
      message.watched.begin(), message.watched.end(), model.watched.halves.begin(),
      [&](const self_awareness::Evidence& half) { return fromMessage(half, model.vocabulary()); });
  core::evidence::checkTracks(model.watched.tracks, model.vocabulary().size());
  for (const self_awareness::GraphEdge& edge : message.graph) {
    model.graph.connect(edge.publisher, edge.topic, edge.subscriber);
  }
  check(model.graph.edges().size() == message.graph.size(), "its graph has an edge twice");
  for (const self_awareness::NodeHost& placed : message.hosts) {
    model.graph.place(placed.node, placed.host);
  }
  for (const self_awareness::Subscription& lasting : message.subscriptions) {
    model.graph.addLasting({lasting.node, lasting.topic}, lasting.recordings);
  }
  for (const self_awareness::TopicNodes& unheard : message.unheard) {
    for (const std::string& source : unheard.publishers) {
      model.graph.addUnheard({source, unheard.topic});
    }
  }
  model.recordings = fromMessages(message.recordings);
  for (const self_awareness::RecordingFindings& findings : message.findings) {
    model.findings.push_back(
        fromMessage(findings, model.watched.tracks.size(), model.vocabulary().size()));
  }
  check(message.calibration.size() <= 1, "it has more than one calibration");
  if (!message.calibration.empty()) {
    model.paper_calibration = fromMessage(message.calibration.front());
  }
  check(message.evidence_calibration.size() <= 1, "it has more than one calibration");
  if (!message.evidence_calibration.empty()) {
    model.calibration = fromMessage(message.evidence_calibration.front(),
                                    model.watched.tracks.size(), model.vocabulary().size());
  }
  return model;
}

void saveModel(const TrainedModel& model, const std::string& path) {
  if (model.isWatched() != model.hasEvidence() || !(model.hasEvidence() || model.hasDelays())) {
    throw std::logic_error("a model is saved with all counts, and with what is watched");
  }
  try {
    OutputFile file(path);
    BagWriter bag(file.temporary(), BagWriter::Chunks::kCompressed, path);
    ModelWriter writer(bag, model.stamp);
    write(model, writer);
    bag.close();
    file.complete();
  } catch (const BagError& error) {
    throw ModelFileError(error.what());
  } catch (const FileError& error) {
    throw ModelFileError(error.what());
  } catch (const std::invalid_argument& error) {
    throw ModelFileError(path + ": the model cannot be written: " + error.what());
  }
}

TrainedModel loadModel(const std::string& path, ModelCounts counts) {
  if (boost::filesystem::exists(path) && !boost::filesystem::is_regular_file(path)) {
    throw ModelFileError(path + ": not a file; name a model");
  }
  if (!boost::filesystem::is_regular_file(path)) {
    throw ModelFileError(path +
                         ": no such file; train a model first "
                         "(rosrun self_awareness train)");
  }
  try {
    ModelMessages messages(path);
    return read(messages, counts);
  } catch (const BagError& error) {
    throw ModelFileError(error.what());
  } catch (const rosbag::BagException& error) {
    throw ModelFileError(path + ": not a model file, or a damaged one (" + error.what() + ")");
  } catch (const std::invalid_argument& error) {
    throw ModelFileError(path + ": a damaged model file: " + error.what());
  } catch (const std::bad_alloc&) {  // damaged numbers ask for much memory
    throw ModelFileError(path + ": a damaged model file, or too little memory");
  }
}

}  // namespace self_awareness::ros1
