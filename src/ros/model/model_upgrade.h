#pragma once

#include <cstdint>
#include <set>
#include <string>

#include "self_awareness/Model.h"

namespace self_awareness::ros1 {

/// Gives the message of a model file of any format the meaning that it has in this version. The
/// bytes were laid out anew already (MessageUpgrade): fields that the file lacks are zero or
/// empty. What is watched on channels that this version does not have is left out.
/// @param format of the file; 1: it says nothing
/// @return the names of these channels
/// @throw std::invalid_argument as removeOtherTracks()
std::set<std::string> upgrade(self_awareness::Model& message, std::uint32_t format);

/// Gives nodes and topics their whole names (resolvedName()): earlier versions took them from bags
/// as they were written there.
/// @return a topic that it knows twice then, which no counts can be added up for; empty: none
std::string resolveNames(self_awareness::Model& message);

/// Removes what is watched on channels of other names, and all that is said by track: in findings,
/// limits and relations.
/// @return the names of the channels of what was removed
/// @throw std::invalid_argument if what is said by track does not fit the tracks
std::set<std::string> removeOtherTracks(self_awareness::Model& message,
                                        const std::set<std::string>& channels);

}  // namespace self_awareness::ros1
