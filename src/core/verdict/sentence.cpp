#include "self_awareness/core/verdict/sentence.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "core/verdict/name_list.h"
#include "self_awareness/core/stream/event.h"

namespace self_awareness::core {
namespace {

constexpr std::size_t kMostNamed = 3;

std::string ofMessages(Kind kind) {
  static const std::map<Kind, std::string> words{
      {Kind::kSilent, "does not come"},
      {Kind::kTopicSilent, "does not come"},
      {Kind::kUnanswered, "does not answer"},
      {Kind::kSlow, "sends too seldom"},
      {Kind::kFast, "sends too often"},
      {Kind::kLate, "paused for too long"},
      {Kind::kOutOfOrder, "sends at an irregular pace"},
      {Kind::kNeverCame, "was not heard"},
      {Kind::kStranger, "is new"},
      {Kind::kUnsubscribed, "does not subscribe"},
      {Kind::kStale, "sends what is too old"},
      {Kind::kLossy, "loses messages"},
      {Kind::kStuck, "sends the same again and again"},
      {Kind::kOtherSize, "sends messages of another size"}};
  const auto found = words.find(kind);
  return found == words.end() ? toString(kind) : found->second;
}

std::string ofAnswers(Kind kind) {
  static const std::map<Kind, std::string> words{
      {Kind::kSilent, "does not answer"},     {Kind::kTopicSilent, "does not answer"},
      {Kind::kUnanswered, "does not answer"}, {Kind::kLate, "answers late"},
      {Kind::kEarly, "answers early"},        {Kind::kOutOfOrder, "comes at unusual delays"}};
  const auto found = words.find(kind);
  return found == words.end() ? toString(kind) : found->second;
}

/// The words for several: "sends too often" becomes "send too often".
std::string plural(const std::string& words) {
  static const std::map<std::string, std::string> verbs{
      {"sends", "send"}, {"answers", "answer"}, {"comes", "come"}, {"does", "do"},
      {"is", "are"},     {"was", "were"},       {"loses", "lose"}};
  const std::size_t end = std::min(words.find(' '), words.size());
  const auto verb = verbs.find(words.substr(0, end));
  return verb == verbs.end() ? words : verb->second + words.substr(end);
}

std::string subjectOf(const Story& story) {
  const std::vector<std::string>& names = story.components;
  if (names.size() > kMostNamed) {
    return std::to_string(names.size()) + " nodes at once (" + names[0] + ", " + names[1] + ", " +
           names[2] + " and others)";
  }
  const bool has_topic = names.size() == 1 && !story.topic.empty() && story.topic != names[0];
  return listed(names, names.size()) + (has_topic ? " (" + story.topic + ")" : "");
}

std::string often(const Story& story, const std::string& when) {
  return story.times > 1 ? std::to_string(story.times) + " times, the longest " + when : when;
}

std::string spanOf(const Story& story) {
  if (story.end.empty() && story.goes_on.empty()) {
    return "since " + (story.begin.empty() ? "the start" : story.begin);
  }
  return "from " + (story.begin.empty() ? "the start" : story.begin) + " to " +
         (story.end.empty() ? story.goes_on : story.end);
}

/// From when on nothing came, and until when.
std::string silenceOf(const Story& story) {
  return often(story, story.begin.empty() ? "since the start" : "at " + story.begin) + story.back;
}

std::string ofAll(const Story& story) {
  const std::string when = silenceOf(story);
  if (story.hosts.empty()) {
    return (story.back.empty() ? "all nodes stopped sending " : "all nodes fell silent ") + when;
  }
  return "everything on host" + std::string(story.hosts.size() > 1 ? "s " : " ") +
         listed(story.hosts, story.hosts.size()) + " fell silent " +
         often(story, story.begin.empty() ? "since the start" : "at " + story.begin) + ": " +
         std::to_string(story.silent) + " nodes" + story.back;
}

std::string utc(std::int64_t stamp) {
  return inUtc(stamp, "%H:%M:%S UTC");
}

/// "0.1 s", with no more digits than a gap needs.
std::string gap(double seconds) {
  char text[40];
  std::snprintf(text, sizeof text, seconds < 10 ? "%.2g s" : "%.0f s", seconds);
  return text;
}

}  // namespace

bool isSilence(const Reason& reason) {
  return isSilence(reason.kind) && reason.after.empty();
}

std::string shortly(const Reason& reason, bool is_silence, bool is_back) {
  if (is_silence && reason.after.empty()) {
    return is_back ? "fell silent" : "stopped sending";
  }
  if (reason.unit == unit::kScore) {
    return "came at unusual times";
  }
  if (reason.kind == Kind::kStale && reason.value < 0) {
    return "sends stamps of the future";
  }
  const bool of_answers = !reason.after.empty() || (reason.of > 0 && reason.times == 0);
  return of_answers ? ofAnswers(reason.kind) : ofMessages(reason.kind);
}

std::string sentence(const Story& story) {
  if (story.kind == Kind::kAllSilent) {
    return ofAll(story);
  }
  const bool is_there = story.kind == Kind::kStranger && !story.reason.empty();
  if (isShared(story.kind) || is_there) {
    return story.reason + ", " + often(story, spanOf(story));
  }
  if (story.components.empty()) {
    return "something is abnormal, " + often(story, spanOf(story)) + "; no suspect stands out";
  }
  const bool several = story.components.size() > 1;
  const std::string said = subjectOf(story) + " " + (several ? plural(story.wrong) : story.wrong);
  if (story.kind == Kind::kNeverCame) {
    return said + " since the start";
  }
  if (story.kind == Kind::kStranger) {
    return said + ": training never heard " + (several ? "them, they were" : "it, it was") +
           " heard " + often(story, spanOf(story));
  }
  return said + " " + (story.is_silence ? silenceOf(story) : often(story, spanOf(story)));
}

std::string sentence(const Alarm& alarm, const std::string& shared) {
  Story story;
  story.kind = alarm.kind;
  story.reason = alarm.kind == Kind::kBusyMachine && !shared.empty() ? shared : alarm.reason;
  story.begin = utc(alarm.begin);
  story.end = alarm.over && !alarm.isToldOnce() ? utc(alarm.end) : "";
  if (alarm.silent) {
    story.hosts = alarm.silent->hosts;
    story.silent = alarm.silent->components.size();
    story.begin = alarm.kind == Kind::kAllSilent ? utc(alarm.silent->since) : story.begin;
  }
  if (story.kind == Kind::kBusyMachine && story.reason.empty()) {
    story.reason = alarm.busy ? describe(*alarm.busy) : "the machine was busy";
  }
  story.back = story.end.empty() ? "" : ", until " + story.end;
  const Suspect* const culprit = alarm.suspectToBlame();
  const bool is_left =
      alarm.culprit.empty() ? alarm.kind == Kind::kAllSilent && !alarm.silent : culprit == nullptr;
  if (is_left && !alarm.reason.empty()) {  // of an alarm of before, no more is known
    return (alarm.culprit.empty() ? "" : alarm.culprit + ": ") + alarm.reason;
  }
  if (alarm.culprit.empty()) {
    return sentence(story);
  }
  Reason reason;
  reason.kind = alarm.kind;
  if (culprit != nullptr) {
    reason = culprit->reason;
    story.topic = culprit->topic + (culprit->value.empty() ? "" : " with " + culprit->value);
    story.begin = culprit->onset > 0 ? utc(culprit->onset) : story.begin;
  }
  const bool is_there = !reason.topics.empty() && reason.kind == Kind::kStranger;
  story.reason = is_there ? alarm.reason : "";
  story.components = {alarm.culprit};
  story.is_silence = isSilence(reason);
  story.wrong = shortly(reason, story.is_silence, alarm.over);
  if (story.is_silence) {
    const bool is_known = std::isfinite(reason.usual);
    const bool says_more = !alarm.reason.empty() && alarm.reason.rfind("silent for", 0) != 0;
    return sentence(story) + (is_known ? ", usually every " + gap(reason.usual) : "") +
           (says_more ? ": " + alarm.reason : "") + (alarm.note.empty() ? "" : "; " + alarm.note) +
           (alarm.waiting.empty() ? "" : "; " + alarm.waiting);
  }
  return sentence(story) + (is_there || alarm.reason.empty() ? "" : ": " + alarm.reason);
}

}  // namespace self_awareness::core
