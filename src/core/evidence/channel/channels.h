#pragma once

#include <vector>

#include "core/evidence/channel/channel.h"

namespace self_awareness::core::evidence {

/// All channels, in the order in which they are named. It is a function of its own file, so that a
/// program may be linked with another list.
const std::vector<const Channel*>& channels();
/// The channels of the method.
std::vector<const Channel*> channelsOfTheMethod();

}  // namespace self_awareness::core::evidence
