#include "self_awareness/core/verdict/sentence.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace self_awareness::core {
namespace {

constexpr std::int64_t kBegin = 1'600'000'000'000'000'000;  // 12:26:40 UTC
constexpr std::int64_t kSecond = kNanosecondsPerSecond;

Story silent(std::vector<std::string> components) {
  Story story;
  story.components = std::move(components);
  story.topic = "/scan";
  story.wrong = "stopped sending";
  story.is_silence = true;
  story.begin = "29.9 s";
  return story;
}

TEST(Sentence, OfASilenceTellsWhoAndSinceWhen) {
  EXPECT_EQ(sentence(silent({"/laser"})), "/laser (/scan) stopped sending at 29.9 s");
  EXPECT_EQ(sentence(silent({"/scan"})), "/scan stopped sending at 29.9 s") << "the topic alone";
  Story several = silent({"/a", "/b"});
  several.begin.clear();
  EXPECT_EQ(sentence(several), "/a and /b stopped sending since the start");
  Story often = silent({"/a", "/b", "/c", "/d"});
  often.times = 3;
  often.wrong = "fell silent";
  often.back = ", and came back at 35.0 s";
  EXPECT_EQ(sentence(often),
            "4 nodes at once (/a, /b, /c and others) fell silent 3 times, the "
            "longest at 29.9 s, and came back at 35.0 s");
}

TEST(Sentence, OfWhatIsNoSilenceHasABeginAndAnEnd) {
  Story slow = silent({"/laser"});
  slow.kind = Kind::kSlow;
  slow.is_silence = false;
  slow.wrong = "sends too seldom";
  EXPECT_EQ(sentence(slow), "/laser (/scan) sends too seldom since 29.9 s");
  slow.goes_on = "the end of the recording";
  EXPECT_EQ(sentence(slow),
            "/laser (/scan) sends too seldom from 29.9 s to the end of the recording");
  slow.end = "40.0 s";
  slow.components = {"/laser", "/slam"};
  EXPECT_EQ(sentence(slow), "/laser and /slam send too seldom from 29.9 s to 40.0 s");
}

TEST(Sentence, WhereNobodyIsToBlameTellsWhatItIs) {
  Story story;
  story.begin = "29.9 s";
  story.kind = Kind::kAllSilent;
  EXPECT_EQ(sentence(story), "all nodes stopped sending at 29.9 s");
  story.hosts = {"base", "head"};
  story.silent = 7;
  story.back = "; they came back at 35.0 s";
  EXPECT_EQ(sentence(story),
            "everything on hosts base and head fell silent at 29.9 s: 7 nodes; "
            "they came back at 35.0 s");
  story.kind = Kind::kBusyMachine;
  story.reason = "the machine may be busy: 5 of 9 components are late";
  EXPECT_EQ(sentence(story), story.reason + ", since 29.9 s");
  story.kind = Kind::kOutOfOrder;
  EXPECT_EQ(sentence(story), "something is abnormal, since 29.9 s; no suspect stands out");
}

Alarm alarmOf(Kind kind) {
  Alarm alarm;
  alarm.begin = kBegin + kSecond;
  alarm.kind = kind;
  alarm.culprit = "/laser";
  alarm.reason = "its numbers";
  Suspect suspect;
  suspect.component = "/laser";
  suspect.topic = "/scan";
  suspect.onset = kBegin;
  suspect.reason.kind = kind;
  suspect.reason.usual = 0.083;
  alarm.suspects = {suspect};
  return alarm;
}

TEST(Sentence, OfAnAlarmIsAboutItsCulpritSinceTheOnset) {
  Alarm alarm = alarmOf(Kind::kSilent);
  alarm.reason = "silent for 1 s";
  EXPECT_EQ(sentence(alarm),
            "/laser (/scan) stopped sending at 12:26:40 UTC, usually every 0.083 s");
  alarm.over = true;
  alarm.end = kBegin + 5 * kSecond;
  EXPECT_EQ(sentence(alarm),
            "/laser (/scan) fell silent at 12:26:40 UTC, until 12:26:45 UTC, "
            "usually every 0.083 s");
  alarm.reason = "not heard by the monitor: it refuses the connection";
  EXPECT_EQ(sentence(alarm).rfind(": not heard by the monitor: it refuses the connection"),
            sentence(alarm).size() - 53);
  alarm = alarmOf(Kind::kUnanswered);
  alarm.suspects.front().reason.after = "/client /request T";
  EXPECT_EQ(sentence(alarm), "/laser (/scan) does not answer since 12:26:40 UTC: its numbers");
  alarm = alarmOf(Kind::kNeverCame);
  EXPECT_EQ(sentence(alarm), "/laser (/scan) was not heard since the start: its numbers");
}

TEST(Sentence, OfAnAlarmOfBeforeTheStartTellsItsReason) {
  Alarm alarm = alarmOf(Kind::kSlow);
  alarm.suspects.clear();
  EXPECT_EQ(sentence(alarm), "/laser: its numbers");
  alarm.culprit.clear();
  alarm.kind = Kind::kBusyMachine;
  EXPECT_EQ(sentence(alarm, "the machine is busy"), "the machine is busy, since 12:26:41 UTC");
}

}  // namespace
}  // namespace self_awareness::core
