#pragma once

#include <vector>

#include "bag_index.h"
#include "self_awareness/ros/bag/bag_reader.h"

namespace self_awareness::ros1 {

/// Finds where the clock was set back while a bag was recorded: messages lie in the file as they
/// came, so stamps go back there, and what came before comes again. Counts on as if it had not
/// been set: by time, what came later would lie among what came before. Bags that are in no order
/// of time, as other programs write them, stay as they are.
/// @param index whose entries get the stamps as they are counted, and stay in their order
/// @return in the order of the recording
std::vector<SetBack> countOn(BagIndex& index);

/// An entry with its stamp as the file has it.
/// @param entry with its stamp as it is counted
BagIndexEntry asStored(BagIndexEntry entry, const std::vector<SetBack>& steps);

}  // namespace self_awareness::ros1
