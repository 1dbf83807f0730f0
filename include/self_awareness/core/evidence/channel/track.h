#pragma once

#include <string>
#include <vector>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::core::evidence {

class Channel;

/// One thing that is watched all the time. What is watched follows from the counts of training.
struct Track {
  const Channel* channel = nullptr;  ///< one of all channels; never null
  EventId to = 0;
  EventId from = 0;  ///< same as `to` if the channel looks at one event type only
};

/// Whom the evidence of a channel speaks against, and how (docs/method.md, section 6).
enum class Finding {
  kSilent,      ///< `to` has not come for too long
  kAbsent,      ///< `to` has not come while `from` goes on
  kUnanswered,  ///< `to` has not come since `from` asked for it
  kFewer,       ///< `to` comes too seldom
  kUnusual,     ///< something is wrong with `to`, whatever the others do
  kBetween      ///< something is wrong with `to`, or with `from`
};

/// Whether `to` has not come.
constexpr bool isAbsence(Finding finding) {
  return finding == Finding::kSilent || finding == Finding::kAbsent ||
         finding == Finding::kUnanswered;
}

/// The channel's name in model files and in Tuning::without.
std::string channelName(const Track& track);
/// The channel's name as people read it: overdue, pace, pairs, deadlines or its own.
std::string channelLabel(const Track& track);
/// Names of all channels.
std::vector<std::string> channelNames();
/// The channel of a name; null if there is none.
const Channel* channelNamed(const std::string& name);

}  // namespace self_awareness::core::evidence
