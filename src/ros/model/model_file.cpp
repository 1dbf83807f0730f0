#include "self_awareness/ros/model/model_file.h"

#include <rosbag/exceptions.h>

#include <algorithm>
#include <boost/filesystem/operations.hpp>
#include <map>
#include <new>
#include <optional>

#include "../bag/bag_index.h"
#include "../bag/stored_messages.h"
#include "../bag/version_of_bag.h"
#include "../check.h"
#include "model_parts.h"
#include "self_awareness/ContentDigest.h"
#include "self_awareness/ModelPart.h"
#include "self_awareness/ros/bag/bag_reader.h"
#include "self_awareness/ros/bag/bag_writer.h"
#include "self_awareness/ros/output_file.h"
#include "self_awareness/ros/ros_time.h"

namespace self_awareness::ros1 {
namespace {

constexpr char kTopic[] = "/model";
constexpr char kDelaysTopic[] = "/delays";
constexpr char kDigestTopic[] = "/digest";
constexpr std::array<const char*, 2> kEvidenceTopics{"/evidence/first", "/evidence/second"};

// Of a file that may be made to fill the memory: many times what the largest model needs.
constexpr std::uint64_t kLargestChunk = 1 << 28;  // [bytes]
constexpr char kOtherCounts[] = "its counts do not fit its event types";

/// The messages of a model file.
class ModelMessages {
 public:
  explicit ModelMessages(const std::string& path)
      : path_(path), index_(readBagIndex(path)), messages_(path, index_, kLargestChunk) {
    readDigests();
  }

  /// @throw BagError as checkedVersion()
  self_awareness::FileVersion version() {
    if (!tellVersion(index_.connections) && !hasModel()) {
      failWithoutModel();
    }
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
        visit(messages_.read<Message>(entry, &digest));
        ++number;
      }
    }
    const auto known = digests_.find(topic);
    check(known == digests_.end() ? digests_.empty() || number == 0
                                  : known->second == digest.value(),
          "its content is not what was written: its digest is another one");
    return number;
  }

  [[noreturn]] void failWithoutModel() const {
    throw ModelFileError(path_ +
                         ": a bag, but it holds no model; train one from it "
                         "(rosrun self_awareness train)");
  }

 private:
  /// Of any format.
  bool hasModel() const {
    return std::any_of(index_.connections.begin(), index_.connections.end(),
                       [](const Connection& connection) {
                         return connection.topic == kTopic &&
                                connection.datatype.rfind("self_awareness/Model", 0) == 0;
                       });
  }
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
  StoredMessages messages_;
  std::map<std::string, std::uint64_t> digests_;  // by topic; none: the file has none
};

/// Reads the parts on a topic, one after the other.
/// @param format that they are of
/// @param visit (reader, number of the part)
/// @return their number
template <typename Visit>
std::size_t readParts(ModelMessages& messages, const std::string& topic, std::uint32_t format,
                      Visit visit) {
  std::size_t number = 0;
  messages.forEach<self_awareness::ModelPart>(topic, [&](const self_awareness::ModelPart& part) {
    ByteReader bytes(part.bytes.data(), part.bytes.size(), format);
    visit(bytes, number++);
    check(bytes.done() || format > kModelFile.format, "there is more in it than belongs to it");
  });
  return number;
}

TrainedModel read(ModelMessages& messages, ModelCounts counts) {
  const self_awareness::FileVersion version = messages.version();
  std::optional<TrainedModel> model;
  const auto readOne = [&](ByteReader& bytes, std::size_t /*number*/) {
    check(!model, "it holds more than one model");
    model = readModel(bytes);
  };
  if (readParts(messages, kTopic, version.format, readOne) == 0) {
    messages.failWithoutModel();
  }
  model->version = version;
  const std::size_t types = model->vocabulary().size();
  if (counts != ModelCounts::kWatched || !model->isWatched()) {
    const std::size_t number =
        readParts(messages, kDelaysTopic, version.format, [&](ByteReader& bytes, std::size_t to) {
          check(to < types, kOtherCounts);
          readDelays(bytes, static_cast<core::EventId>(to), model->statistics);
        });
    check(number == types || (number == 0 && model->isWatched()), kOtherCounts);
  }
  const std::size_t halves = counts == ModelCounts::kAll && model->isWatched() ? 2 : 0;
  for (std::size_t half = 0; half < halves; ++half) {
    core::evidence::Statistics& statistics = model->evidence.at(half);
    statistics = model->watched.halves.at(half).withoutPairs();
    const std::size_t number =
        readParts(messages, kEvidenceTopics.at(half), version.format,
                  [&](ByteReader& bytes, std::size_t id) {
                    check(id < types, kOtherCounts);
                    readPairs(bytes, static_cast<core::EventId>(id), statistics);
                  });
    check(number == types, kOtherCounts);
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
  /// Writes a part of a model.
  /// @return its bytes
  template <typename Write>
  std::vector<std::uint8_t> writePart(const std::string& topic, Write writeTo) {
    ByteWriter bytes;
    writeTo(bytes);
    self_awareness::ModelPart part;
    part.bytes = bytes.take();
    write(topic, part);
    return std::move(part.bytes);
  }
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
  const std::vector<std::uint8_t> written =
      file.writePart(kTopic, [&](ByteWriter& bytes) { writeModel(model, bytes); });
  // A file that nobody could read would be found out when it is needed.
  ByteReader bytes(written.data(), written.size(), version.format);
  readModel(bytes);
  for (core::EventId id = 0; id < model.vocabulary().size(); ++id) {
    if (model.hasDelays()) {
      file.writePart(kDelaysTopic,
                     [&](ByteWriter& part) { writeDelays(model.statistics, id, part); });
    }
    for (std::size_t half = 0; model.hasEvidence() && half < model.evidence.size(); ++half) {
      file.writePart(kEvidenceTopics.at(half),
                     [&](ByteWriter& part) { writePairs(model.evidence[half], id, part); });
    }
  }
  file.writeDigests();
}

}  // namespace

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
