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

TEST(Suspect, AChannelHasWordsOfItsOwn) {
  Suspect other = suspect(Reason::kOther);
  EXPECT_EQ(describe(other), "");
  other.words = "in bursts";
  EXPECT_EQ(describe(other), "in bursts");
  Suspect silent = suspect(Reason::kSilent);
  silent.words = "not as it should be";
  EXPECT_EQ(describe(silent), "not as it should be") << "they come first";
}

}  // namespace
}  // namespace self_awareness::core
