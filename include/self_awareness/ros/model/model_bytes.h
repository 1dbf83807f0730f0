#pragma once

#include <string>

#include "self_awareness/ros/model/model_file.h"

namespace self_awareness::ros1 {

/// A model as bytes for another process, with the counts that it holds.
std::string toBytes(const TrainedModel& model);
/// @throw std::invalid_argument if the bytes are of another version of the message, or damaged
TrainedModel fromBytes(const std::string& bytes);

}  // namespace self_awareness::ros1
