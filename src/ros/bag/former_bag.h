#pragma once

#include <string>

#include "bag_index.h"

namespace self_awareness::ros1 {

/// The index of a bag of format 1.2, by rosbag. It is checked before: rosbag believes what the
/// file says.
/// @throw rosbag::BagException if it is of another format or damaged
BagIndex readFormerBag(const std::string& path);

}  // namespace self_awareness::ros1
