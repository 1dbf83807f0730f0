#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <ros/types.h>

#include <boost/make_shared.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace self_awareness::ros1 {

/// A message as it comes over the wire.
template <typename Message>
std::vector<std::uint8_t> serialized(const Message& message) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

/// The header of a connection that brings such messages.
template <typename Message>
boost::shared_ptr<ros::M_string> headerOf(const std::string& callerid, bool latching = false) {
  namespace traits = ros::message_traits;
  return boost::make_shared<ros::M_string>(
      ros::M_string{{"callerid", callerid},
                    {"latching", latching ? "1" : "0"},
                    {"type", traits::datatype<Message>()},
                    {"md5sum", traits::md5sum<Message>()},
                    {"message_definition", traits::definition<Message>()}});
}

}  // namespace self_awareness::ros1
