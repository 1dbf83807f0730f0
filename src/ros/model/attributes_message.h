#pragma once

#include "self_awareness/AttributeCounts.h"
#include "self_awareness/core/evidence/count/attribute_counts.h"

namespace self_awareness::ros1 {

self_awareness::AttributeCounts toMessage(const core::evidence::AttributeCounts& counts);
/// @throw std::invalid_argument names the contradiction in the message
core::evidence::AttributeCounts fromMessage(const self_awareness::AttributeCounts& message);

}  // namespace self_awareness::ros1
