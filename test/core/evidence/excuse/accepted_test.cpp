#include "core/evidence/excuse/accepted.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "../../verdict/accepted.h"
#include "../recordings.h"
#include "core/evidence/channel/scorer.h"

namespace self_awareness::core::evidence {
namespace {

using Names = std::set<std::string>;

/// B answers to A, with messages that have attributes, and C is a timer.
Events robot(unsigned seed) {
  const Events asked = irregular(kA, 0, 300 * kSecond, 200 * kMillisecond, seed);
  Events answers = messages(kB, 0, 300 * kSecond, {}, seed);
  answers.resize(asked.size());
  for (std::size_t k = 0; k < asked.size(); ++k) {
    answers[k].stamp = asked[k].stamp + 20 * kMillisecond;
  }
  return together({asked, answers, timer(kC, 0, 300 * kSecond, 100 * kMillisecond)});
}

class AcceptedTest : public testing::Test {
 protected:
  /// The channels whose evidence against B, or about it, is left out.
  Names leftOut(std::optional<Kind> kind, const std::string& component = "/b") {
    accepted_.accept(allOf({accepted(component, "", kind)}));
    std::vector<double> evidence(model_->tracks().size(), 1);
    accepted_.leaveOut(scorer_.heard(), evidence);
    Names names;
    for (std::size_t track = 0; track < evidence.size(); ++track) {
      if (evidence[track] == 0) {
        names.insert(channelName(model_->tracks()[track]));
      }
    }
    return names;
  }

  static Tuning tuning() {
    Tuning tuning;
    tuning.changing_time = 0;
    return tuning;
  }

  std::shared_ptr<const Model> model_ =
      std::make_shared<const Model>(watch(countsOf({robot(1), later(robot(2))}),
                                          countsOf({later(robot(3), 2 * kStart)}), {}, tuning()));
  Scorer scorer_{model_, kWindow};
  Accepted accepted_{model_, nullptr};
};

TEST_F(AcceptedTest, AKindIsAcceptedWithWhatComesWithItAndNoMore) {
  Names all;
  for (const Track& track : model_->tracks()) {
    if (track.to == kB) {
      all.insert(channelName(track));
    }
  }
  const Names time{kSlower, kFaster, kPairs};
  const Names messages{kAge, kLost, kSize, kFrozen};
  for (const Names* const part : {&time, &messages}) {
    for (const std::string& channel : *part) {
      EXPECT_EQ(all.count(channel), 1U) << channel << " is not watched: the test needs it";
    }
  }
  EXPECT_EQ(all.count(kOverdue) + all.count(kDeadlines), 2U);
  for (const Kind kind :
       {Kind::kSlow, Kind::kFast, Kind::kLate, Kind::kEarly, Kind::kOutOfOrder}) {
    EXPECT_EQ(leftOut(kind), time) << toString(kind);
  }
  for (const Kind kind : {Kind::kStale, Kind::kLossy, Kind::kOtherSize, Kind::kStuck}) {
    EXPECT_EQ(leftOut(kind), messages) << toString(kind);
    EXPECT_FALSE(accepted_.mayBeSilent()[kB]) << toString(kind);
  }
  for (const Kind kind : {Kind::kStranger, Kind::kUnsubscribed, Kind::kAllSilent}) {
    EXPECT_EQ(leftOut(kind), Names{}) << toString(kind);
    EXPECT_FALSE(accepted_.mayBeSilent()[kB]) << toString(kind);
  }
  for (const std::optional<Kind> kind : {std::optional<Kind>(), {Kind::kSilent}}) {
    EXPECT_EQ(leftOut(kind), all);
    EXPECT_TRUE(accepted_.mayBeSilent()[kB]);
  }
}

TEST_F(AcceptedTest, OfATimerItsOwnGapsAreItsTime) {
  EXPECT_EQ(leftOut(Kind::kFast, "/c").count(kSlower), 1U);
  EXPECT_EQ(leftOut(Kind::kStuck, "/c").count(kSlower), 0U);
  EXPECT_EQ(leftOut(Kind::kLate, "/a").count(kPairs), 1U) << "either excuses what is between two";
  EXPECT_EQ(leftOut(Kind::kStale, "/a").count(kPairs), 0U);
}

TEST_F(AcceptedTest, OnlySuspectsOfThatKindAreDropped) {
  leftOut(Kind::kOtherSize);
  std::vector<Suspect> suspects(3);
  for (Suspect& suspect : suspects) {
    suspect.id = kB;
    suspect.component = "/b";
  }
  suspects[0].reason.kind = Kind::kStale;
  suspects[1].reason.kind = Kind::kSilent;
  suspects[2].reason.kind = Kind::kUnsubscribed;
  accepted_.leaveOut(suspects);
  ASSERT_EQ(suspects.size(), 2U);
  EXPECT_EQ(suspects[0].reason.kind, Kind::kSilent);
}

}  // namespace
}  // namespace self_awareness::core::evidence
