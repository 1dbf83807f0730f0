#include "self_awareness/ros/model/model_bytes.h"

#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <cstdint>
#include <cstring>
#include <stdexcept>

#include "../message_check.h"
#include "packed_pairs.h"
#include "self_awareness/ros/model/delays_message.h"
#include "self_awareness/ros/model/evidence_message.h"

namespace self_awareness::ros1 {
namespace {

namespace serialization = ros::serialization;
using Length = std::uint32_t;

// Bits of the byte that says which counts follow the model.
constexpr unsigned kDelays = 1;
constexpr unsigned kEvidence = 2;

std::string version() {
  return std::string(ros::message_traits::md5sum<self_awareness::Model>()) +
         ros::message_traits::md5sum<self_awareness::DelayHistograms>() +
         ros::message_traits::md5sum<self_awareness::PackedPairs>() +
         ros::message_traits::md5sum<self_awareness::FileVersion>();
}

/// Appends the length of a message, and the message.
template <typename Message>
void append(const Message& message, std::string& bytes) {
  const Length length = serialization::serializationLength(message);
  const std::size_t begin = bytes.size();
  bytes.resize(begin + sizeof length + length);
  std::memcpy(&bytes[begin], &length, sizeof length);
  serialization::OStream stream(reinterpret_cast<std::uint8_t*>(&bytes[begin + sizeof length]),
                                length);
  serialization::serialize(stream, message);
}

/// Takes one message after the other.
class Reader {
 public:
  Reader(const std::string& bytes, std::size_t begin) : bytes_(bytes), next_(begin) {}

  bool done() const { return next_ == bytes_.size(); }

  unsigned takeByte() {
    require(1);
    return static_cast<unsigned char>(bytes_[next_++]);
  }

  template <typename Message>
  Message take() {
    Length length = 0;
    require(sizeof length);
    std::memcpy(&length, &bytes_[next_], sizeof length);
    next_ += sizeof length;
    require(length);
    const auto* data = reinterpret_cast<const std::uint8_t*>(bytes_.data() + next_);
    next_ += length;
    try {
      return readMessage<Message>(data, length);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(std::string("a damaged model: ") + error.what());
    }
  }

 private:
  void require(std::size_t number) const {
    if (bytes_.size() - next_ < number) {
      throw std::invalid_argument("a damaged model: it ends too soon");
    }
  }

  const std::string& bytes_;
  std::size_t next_;
};

}  // namespace

std::string toBytes(const TrainedModel& model) {
  std::string bytes = version();
  append(toMessage(model), bytes);
  append(model.version, bytes);
  bytes.push_back(static_cast<char>((model.hasDelays() ? kDelays : 0U) |
                                    (model.hasEvidence() ? kEvidence : 0U)));
  for (core::EventId id = 0; id < model.vocabulary().size(); ++id) {
    if (model.hasDelays()) {
      append(toMessage(model.statistics, id), bytes);
    }
    for (std::size_t k = 0; model.hasEvidence() && k < model.evidence.size(); ++k) {
      const core::evidence::Statistics& half = model.evidence[k];
      if (id == 0) {
        append(toMessage(half.withoutPairs()), bytes);
      }
      append(packedPairs(half, id), bytes);
    }
  }
  return bytes;
}

TrainedModel fromBytes(const std::string& bytes) {
  const std::string expected = version();
  if (bytes.compare(0, expected.size(), expected) != 0) {
    throw std::invalid_argument("a model of another version of self_awareness");
  }
  Reader reader(bytes, expected.size());
  TrainedModel model = fromMessage(reader.take<self_awareness::Model>());
  model.version = reader.take<self_awareness::FileVersion>();
  const unsigned counts = reader.takeByte();
  for (core::EventId id = 0; id < model.vocabulary().size(); ++id) {
    if ((counts & kDelays) != 0) {
      addMessage(reader.take<self_awareness::DelayHistograms>(), model.statistics);
    }
    for (std::size_t k = 0; (counts & kEvidence) != 0 && k < model.evidence.size(); ++k) {
      core::evidence::Statistics& half = model.evidence[k];
      if (id == 0) {
        half = fromMessage(reader.take<self_awareness::Evidence>(), model.vocabulary());
      }
      setPairs(reader.take<self_awareness::PackedPairs>(), half);
    }
  }
  if (!reader.done()) {
    throw std::invalid_argument("a damaged model: there is more than belongs to it");
  }
  return model;
}

}  // namespace self_awareness::ros1
