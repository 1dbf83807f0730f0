#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>

namespace self_awareness::ros1 {

/// A message of any type whose content nobody wants: roscpp hands on when it came and from whom.
struct UnreadMessage {};

}  // namespace self_awareness::ros1

namespace ros {
namespace message_traits {

template <>
struct IsMessage<self_awareness::ros1::UnreadMessage> : TrueType {};
template <>
struct IsMessage<const self_awareness::ros1::UnreadMessage> : TrueType {};

template <>
struct MD5Sum<self_awareness::ros1::UnreadMessage> {
  static const char* value() { return "*"; }
  static const char* value(const self_awareness::ros1::UnreadMessage& /*message*/) {
    return value();
  }
};

template <>
struct DataType<self_awareness::ros1::UnreadMessage> {
  static const char* value() { return "*"; }
  static const char* value(const self_awareness::ros1::UnreadMessage& /*message*/) {
    return value();
  }
};

template <>
struct Definition<self_awareness::ros1::UnreadMessage> {
  static const char* value() { return ""; }
  static const char* value(const self_awareness::ros1::UnreadMessage& /*message*/) {
    return value();
  }
};

}  // namespace message_traits

namespace serialization {

/// Only to receive: it is never published.
template <>
struct Serializer<self_awareness::ros1::UnreadMessage> {
  template <typename Stream>
  static void read(Stream& stream, self_awareness::ros1::UnreadMessage& /*message*/) {
    stream.advance(stream.getLength());
  }
};

}  // namespace serialization
}  // namespace ros
