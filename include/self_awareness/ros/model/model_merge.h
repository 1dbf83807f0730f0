#pragma once

#include "self_awareness/ros/model/model_file.h"

namespace self_awareness::ros1 {

/// Adds what another model learned: counts to counts, and half to half. The order in which models
/// are added decides nothing but the ids. Edges and recordings are those of both. Calibrations are
/// dropped, since they were made for fewer counts, and watch() must be called again. Counts do not
/// depend on the numbers of the method: where those of the two differ, the sum has the defaults.
/// @throw std::invalid_argument if the two do not count the same things, or a type field has too
/// many values in both together; says what it is, and leaves the model as it was
void merge(TrainedModel& model, const TrainedModel& other);

}  // namespace self_awareness::ros1
