#pragma once

#include <ros/node_handle.h>

#include "self_awareness/ros/encoding.h"

namespace self_awareness {

/// Reads how messages become events from the namespace `encoding` of the parameters, as
/// config/encoding.yaml is loaded there. A key that is not set keeps its value of
/// EncodingRules::defaults().
/// @throw std::invalid_argument names the parameter that is unknown, of the wrong kind, or no
/// regular expression, or what EncodingRules::validate() refuses
ros1::EncodingRules loadEncoding(const ros::NodeHandle& private_node_handle);

}  // namespace self_awareness
