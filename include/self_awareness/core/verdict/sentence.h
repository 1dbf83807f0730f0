#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "self_awareness/core/verdict/alarm.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core {

/// What happened, as far as it is known, for the one sentence that says it. Times are in words:
/// "29.9 s" from the start of a recording, or "14:03:07 UTC".
struct Story {
  Kind kind = Kind::kSilent;
  std::vector<std::string> components;  ///< to blame: the culprit, and who failed at once with it
  std::string topic;   ///< what of the culprit is wrong, if it is alone; empty: all of it
  std::string wrong;   ///< what it does wrong, as shortly() says
  std::string reason;  ///< the same where nobody is to blame, or it is there and should not be
  bool is_silence = false;         ///< nothing came meanwhile: then `begin` is the last message
  std::string begin;               ///< empty: the start
  std::string end;                 ///< empty: it goes on
  std::string goes_on;             ///< then: until when, in words; empty: nobody knows
  std::string back;                ///< who came back when, in words; empty: nobody did
  std::size_t times = 1;           ///< alarms; above 1, the times are those of the longest
  std::vector<std::string> hosts;  ///< computers that fell silent as a whole
  std::size_t silent = 0;          ///< components that did
};

/// An incident, or an alarm, in a sentence without its full stop: "/player (/scan) stopped sending
/// at 29.9 s". All who tell of one say it: live, of recordings, in reports and for programs.
std::string sentence(const Story& story);
/// The same of an alarm or a suspicion, live: its culprit, and how that usually is. Times are UTC.
/// @param shared what the components share is wrong with, in words; empty: it is not known
std::string sentence(const Alarm& alarm, const std::string& shared = "");

/// What somebody does wrong, in a few words: "sends too often", "answers late".
/// @param is_silence nothing of it came
/// @param is_back it came again
std::string shortly(const Reason& reason, bool is_silence, bool is_back);
/// Whether a reason is that nothing came for a while of itself, not as an answer.
bool isSilence(const Reason& reason);

}  // namespace self_awareness::core
