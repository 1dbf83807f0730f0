#include "self_awareness/ros/model_bytes.h"

#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <cstdint>
#include <stdexcept>

namespace self_awareness::ros1 {
namespace {

namespace serialization = ros::serialization;

std::string version() {
  return ros::message_traits::md5sum<self_awareness::Model>();
}

}  // namespace

std::string toBytes(const TrainedModel& model) {
  const self_awareness::Model message = toMessage(model);
  std::string bytes = version();
  const std::size_t header = bytes.size();
  const std::uint32_t length = serialization::serializationLength(message);
  bytes.resize(header + length);
  serialization::OStream stream(reinterpret_cast<std::uint8_t*>(&bytes[header]), length);
  serialization::serialize(stream, message);
  return bytes;
}

TrainedModel fromBytes(const std::string& bytes) {
  const std::string expected = version();
  if (bytes.compare(0, expected.size(), expected) != 0) {
    throw std::invalid_argument("a model of another version of self_awareness");
  }
  // The stream takes its bytes for writable, though nothing is written.
  serialization::IStream stream(
      reinterpret_cast<std::uint8_t*>(const_cast<char*>(bytes.data() + expected.size())),
      static_cast<std::uint32_t>(bytes.size() - expected.size()));
  self_awareness::Model message;
  try {
    serialization::deserialize(stream, message);
  } catch (const serialization::StreamOverrunException& error) {
    throw std::invalid_argument(std::string("a damaged model: ") + error.what());
  }
  return fromMessage(message);
}

}  // namespace self_awareness::ros1
