#pragma once

#include <vector>

#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/model/model_file.h"

namespace self_awareness::ros1 {

/// Adds what another model learned (core::Model::add()); its file says the older method of the
/// two.
/// @throw std::invalid_argument if the two do not count the same things, or a type field has too
/// many values in both together; says what it is, and leaves the model as it was
void merge(TrainedModel& model, const TrainedModel& other);

/// Renames what a model has learned, as if it had been trained with these rules after its own.
/// Calibrations are dropped, and watch() must be called again.
/// @throw std::invalid_argument if two event types become one, whose counts cannot be added up, or
/// a rule cannot be; leaves the model as it was
void rename(TrainedModel& model, const std::vector<Rename>& rules);

}  // namespace self_awareness::ros1
