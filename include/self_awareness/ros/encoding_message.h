#pragma once

#include "self_awareness/Encoding.h"
#include "self_awareness/ros/encoding.h"

namespace self_awareness::ros1 {

/// The rules as models and event logs store them.
self_awareness::Encoding toMessage(const EncodingRules& rules);
/// @throw std::invalid_argument if the source is unknown, or as EncodingRules::validate()
EncodingRules fromMessage(const self_awareness::Encoding& message);

}  // namespace self_awareness::ros1
