#include "self_awareness/core/verdict/suspect.h"

#include <gtest/gtest.h>

namespace self_awareness::core {
namespace {

using Reason = Suspect::Reason;

Suspect suspect(Reason reason) {
  Suspect suspect;
  suspect.reason = reason;
  return suspect;
}

Suspect delayed(double delay, const std::string& other) {
  Suspect delayed = suspect(Reason::kDelay);
  delayed.other = other;
  delayed.usual_delay = 0.045;
  delayed.delay = delay;
  delayed.lasted = 12.04;
  delayed.of = 40;
  delayed.times = 38;
  return delayed;
}

TEST(Suspect, ASilentOneIsDescribedByWhatTrainingKnows) {
  Suspect silent = suspect(Reason::kSilent);
  silent.silence = 2.31;
  silent.usual_shortest = 0.07;
  silent.usual_longest = 0.09;
  EXPECT_EQ(describe(silent), "silent for 2.31 s, usually every 0.070 to 0.090 s");
  silent.usual_gap = 0.2;
  silent.longest_gap = 0.2314;
  EXPECT_EQ(describe(silent), "silent for 2.31 s, usually every 0.200 s, at most 0.231 s");
  silent.reason = Reason::kLate;
  EXPECT_EQ(describe(silent), "came after 2.31 s, usually every 0.200 s, at most 0.231 s");
}

TEST(Suspect, ARateIsDescribedByCounts) {
  Suspect slow = suspect(Reason::kRate);
  slow.events = 12;
  slow.usual_fewest = 17.8;
  slow.usual_most = 22.2;
  EXPECT_EQ(describe(slow), "12 in the last 2 s, usually 18 to 22");
}

TEST(Suspect, DelaysAreDescribedByWhatTheirSumSaw) {
  EXPECT_EQ(describe(delayed(0.0471, "/a /x T")),
            "2.1 ms later than usual 38 times of 40 after /a /x T in the last 12.0 s, usually "
            "0.045 s");
  EXPECT_EQ(describe(delayed(0.0429, "")),
            "2.1 ms earlier than usual 38 times of 40 in the last 12.0 s, usually every 0.045 s");
  EXPECT_EQ(describe(delayed(0.245, "")).rfind("200 ms later than usual 38 times", 0), 0U);
  EXPECT_EQ(describe(delayed(3.045, "")).rfind("3.00 s later than usual 38 times", 0), 0U);
  Suspect scattered = delayed(0.0471, "");
  scattered.scatter = 0.012;
  scattered.times = 1;
  EXPECT_EQ(describe(scattered),
            "12.0 ms earlier or later than usual 1 time of 40 in the last 12.0 s, usually every "
            "0.045 s");
  EXPECT_EQ(describe(suspect(Reason::kDelay)), "at unusual delays");
}

TEST(Suspect, AnswersAreDescribedByWhatTheirSumSaw) {
  Suspect silent = suspect(Reason::kAnswer);
  silent.other = "/a /x T";
  EXPECT_EQ(describe(silent), "left out too often after /a /x T");
  silent.lasted = 3.21;
  silent.of = 9;
  silent.times = 7;
  for (const auto& [share, usual] :
       {std::pair(0.05, "1 in 20"), std::pair(0.42, "1 in 2.4"), std::pair(1.0 / 3, "1 in 3"),
        std::pair(0.0004, "1 in 2500"), std::pair(0.0, "never")}) {
    silent.usual_share = share;
    EXPECT_EQ(
        describe(silent),
        std::string("left out 7 times of 9 after /a /x T in the last 3.2 s, usually ") + usual);
  }
}

}  // namespace
}  // namespace self_awareness::core
