#pragma once

#include <string>

#include "self_awareness/ros/model/model_file.h"

namespace self_awareness::ros1 {

/// A model as bytes, to be handed to another process, with its counts where it has them.
std::string toBytes(const TrainedModel& model);
/// @throw std::invalid_argument if the bytes are of another version of the message, or damaged
TrainedModel fromBytes(const std::string& bytes);

}  // namespace self_awareness::ros1
