#pragma once

#include <vector>

#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/model/model_file.h"

namespace self_awareness::ros1 {

/// Adds what another model learned: counts to counts, and half to half. The order in which models
/// are added decides nothing but the ids. Edges and recordings are those of both. Calibrations are
/// dropped, since they were made for fewer counts, and watch() must be called again. Counts do not
/// depend on the numbers of the method: where those of the two differ, the sum has the defaults.
/// @throw std::invalid_argument if the two do not count the same things, or a type field has too
/// many values in both together; says what it is, and leaves the model as it was
void merge(TrainedModel& model, const TrainedModel& other);

/// Renames what a model has learned, as if it had been trained with these rules after its own.
/// Calibrations are dropped, and watch() must be called again.
/// @throw std::invalid_argument if two event types become one, whose counts cannot be added up, or
/// a rule cannot be; leaves the model as it was
void rename(TrainedModel& model, const std::vector<Rename>& rules);

}  // namespace self_awareness::ros1
