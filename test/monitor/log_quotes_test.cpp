#include "monitor/log_quotes.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <rosgraph_msgs/Log.h>

#include "../problem.h"
#include "../ros/serialized.h"

namespace self_awareness {
namespace {

const core::EventType kError{"/laser", "/rosout", "rosgraph_msgs/Log[level=8]"};

ros1::Content line(rosgraph_msgs::Log::_level_type level, const std::string& text) {
  rosgraph_msgs::Log log;
  log.header.frame_id = "somewhere";
  log.level = level;
  log.name = "/laser";
  log.msg = text;
  return ros1::serialized(log);
}

std::string wordsOf(LogQuotes& quotes, core::EventId id) {
  core::Suspect suspect;
  suspect.id = id;
  suspect.reason = core::strangerIn(1);
  core::Verdict verdict;
  verdict.suspects = {suspect};
  ros1::Circumstances circumstances;
  quotes.onVerdict(verdict, circumstances);
  return verdict.suspects.front().reason.words;
}

TEST(LogQuotes, ANodeThatLogsAnewIsNamedWithWhatItSaid) {
  LogQuotes quotes;
  quotes.add(7, kError, line(8, "lost the laser\n\033[31mred"));
  EXPECT_EQ(wordsOf(quotes, 7),
            "/laser logged ERROR \"lost the laser \uFFFD[31mred\", and nothing of that level in "
            "training");
  EXPECT_EQ(wordsOf(quotes, 8), "never seen in training, 1 in this window");
  quotes.add(7, kError, line(8, "again"));
  EXPECT_TRUE(has(wordsOf(quotes, 7), "\"again\"")) << "the last one";
  quotes.onCut(Cut::kOtherModel);
  EXPECT_EQ(wordsOf(quotes, 7), "never seen in training, 1 in this window");
}

TEST(LogQuotes, ANodeThatReportsAnErrorAnewIsNamedWithItsWorstStatus) {
  diagnostic_msgs::DiagnosticArray message;
  message.status.resize(2);
  message.status[1].level = diagnostic_msgs::DiagnosticStatus::ERROR;
  message.status[1].name = "gps";
  message.status[1].message = "no fix";
  const core::EventType error{"/gps", "/diagnostics",
                              "diagnostic_msgs/DiagnosticArray[lists status.level: 2]"};
  LogQuotes quotes;
  quotes.add(7, error, ros1::serialized(message));
  EXPECT_EQ(wordsOf(quotes, 7),
            "/gps says on /diagnostics \"gps: no fix\", and nothing so bad in training");
  quotes.add(8, error, {1, 2, 3});
  EXPECT_EQ(wordsOf(quotes, 8), "never seen in training, 1 in this window");
}

TEST(LogQuotes, LongLinesAreCut) {
  LogQuotes quotes;
  quotes.add(1, kError, line(16, std::string(LogQuotes::kLongest, 'a')));
  quotes.add(2, kError, line(16, std::string(10 * LogQuotes::kLongest, 'b')));
  EXPECT_TRUE(has(wordsOf(quotes, 1), "aaa\", and"));
  EXPECT_TRUE(has(wordsOf(quotes, 2), "bbb...\", and"));
  EXPECT_LT(wordsOf(quotes, 2).size(), LogQuotes::kLongest + 100);
}

TEST(LogQuotes, OtherMessagesAndBrokenOnesAreNotQuoted) {
  LogQuotes quotes;
  quotes.add(1, {"/laser", "/scan", "sensor_msgs/LaserScan"}, line(8, "text"));
  ros1::Content broken = line(8, "text");
  broken.resize(30);
  quotes.add(2, kError, broken);
  for (const core::EventId id : {1U, 2U}) {
    EXPECT_EQ(wordsOf(quotes, id), "never seen in training, 1 in this window");
  }
}

}  // namespace
}  // namespace self_awareness
