#pragma once

#include <self_awareness/Model.h>
#include <self_awareness/Tuning.h>

#include "self_awareness/core/evidence/tuning.h"

namespace self_awareness::ros1 {

self_awareness::Tuning toMessage(const core::evidence::Tuning& tuning);
/// The numbers that a model was trained with, of any format. What it does not hold has its
/// default; what this version does not know is left out.
/// @throw std::invalid_argument names a number that is out of its range
core::evidence::Tuning tuningOf(const self_awareness::Model& message);

}  // namespace self_awareness::ros1
