#pragma once

#include <optional>
#include <string>
#include <vector>

#include "self_awareness/Suspect.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/verdict/alarm.h"
#include "self_awareness/core/verdict/detector.h"

namespace self_awareness::ros1 {

/// @param vocabulary that the suspects' ids are of
std::vector<self_awareness::Suspect> toMessages(const std::vector<core::Suspect>& suspects,
                                                const core::Vocabulary& vocabulary);

/// What is wrong with the component of a suspect: "SCOPE: REASON", and between them the value of
/// the type field if there is one, "/rosout [level=8]: never seen in training, 1 in this window".
std::string describeOnScope(const self_awareness::Suspect& suspect);

/// "SOURCE on SCOPE: REASON", without the source where the encoding leaves it out.
std::string describe(const self_awareness::Suspect& suspect);

/// Something of a topic with who sends it, as people read it: "/player on /scan".
/// @param source empty: it is not known
std::string withSource(const std::string& source, const std::string& of_topic);

/// The verdict in words.
/// @param standing the alarm or the suspicion that stands: its sentence comes first
/// @param evidence of the last window that had any, while the level is not OK
/// @param new_suspects those of this window
/// @param shared what is wrong with what components share, in words; empty: nothing
std::string wording(const core::Verdict& verdict, const std::optional<core::Alarm>& standing,
                    const std::string& evidence,
                    const std::vector<self_awareness::Suspect>& new_suspects,
                    const std::string& shared = "");

}  // namespace self_awareness::ros1
