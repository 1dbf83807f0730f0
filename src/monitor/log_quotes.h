#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "part.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/verdict/suspect.h"
#include "self_awareness/ros/live/live_events.h"

namespace self_awareness {

/// Remembers what nodes last said of each event type that training never saw, on /rosout or on
/// /diagnostics, so that one that says an error for the first time is named with its words.
class LogQuotes : public Part {
 public:
  /// Longest quote [bytes].
  static constexpr std::size_t kLongest = 200;

  /// Takes in a message of an event type that the model does not know.
  void add(core::EventId id, const core::EventType& type, const ros1::Content& content);
  /// Forgets all: ids mean something else from now on.
  void onCut(Cut why) override;
  /// Gives suspects of these event types the words.
  void onVerdict(core::Verdict& verdict, ros1::Circumstances& circumstances) override;

 private:
  void explain(std::vector<core::Suspect>& suspects) const;

  std::map<core::EventId, std::string> words_;
};

}  // namespace self_awareness
