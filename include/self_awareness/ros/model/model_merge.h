#pragma once

#include "self_awareness/ros/model/model_file.h"

namespace self_awareness::ros1 {

/// Adds what another model learned: counts to counts and half to half, so that the order in which
/// models are added decides on nothing but the ids. Edges and recordings are those of both.
/// Calibrations are dropped, as they were made for less, and what is watched is to be chosen anew.
/// @throw std::invalid_argument says what differs where the two do not count the same things, or
/// which type field has too many values together; the model is as it was then
void merge(TrainedModel& model, const TrainedModel& other);

}  // namespace self_awareness::ros1
