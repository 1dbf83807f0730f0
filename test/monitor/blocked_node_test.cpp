#include "monitor/blocked_node.h"

#include <gtest/gtest.h>

namespace self_awareness {
namespace {

using ros1::Answer;

TEST(WhoBlocks, IsASubscriberThatHangsIfTheSilentNodeAnswers) {
  Discovery::Answers answers{{"/cam", Answer::kGiven},
                             {"/viewer", Answer::kNone},
                             {"/rviz", Answer::kNone},
                             {"/detector", Answer::kGiven},
                             {"/gone", Answer::kRefused}};
  EXPECT_EQ(whoBlocks({"/cam"}, {"/viewer", "/detector", "/gone"}, answers),
            "it answers, but its subscriber /viewer does not");
  EXPECT_EQ(whoBlocks({"/cam"}, {"/viewer", "/rviz"}, answers),
            "it answers, but its subscribers /rviz and /viewer do not");
  EXPECT_EQ(whoBlocks({"/cam"}, {"/detector", "/gone"}, answers), "");
  EXPECT_EQ(whoBlocks({"/cam"}, {"/not_asked"}, answers), "");
}

TEST(WhoBlocks, IsNobodyIfTheSilentNodeDoesNotAnswer) {
  Discovery::Answers answers{{"/viewer", Answer::kNone}};
  EXPECT_EQ(whoBlocks({"/cam"}, {"/viewer"}, answers), "") << "nobody had time to ask it";
  for (const Answer answer : {Answer::kNone, Answer::kRefused}) {
    answers["/cam"] = answer;
    EXPECT_EQ(whoBlocks({"/cam"}, {"/viewer"}, answers), "");
  }
}

}  // namespace
}  // namespace self_awareness
