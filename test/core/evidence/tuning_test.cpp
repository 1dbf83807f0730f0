#include "self_awareness/core/evidence/tuning.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "../../problem.h"
#include "attributed.h"
#include "recordings.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/evidence/channel/watched.h"
#include "self_awareness/core/evidence/limits/limits.h"

namespace self_awareness::core::evidence {
namespace {

std::string errorOfSetting(const std::string& name, double value) {
  Tuning tuning;
  const std::string error = problemOf([&] { set(tuning, name, value); });
  EXPECT_EQ(tuning == Tuning{}, !error.empty()) << "what is refused changes nothing";
  return error;
}

TEST(EvidenceTuning, EveryMemberIsInTheTable) {
  // Without a number in the table, a model file would not keep it.
  // NOLINTNEXTLINE(bugprone-sizeof-container): how large the member is, not what it holds
  EXPECT_EQ(tuningNumbers().size() * sizeof(double) + sizeof(Tuning::without), sizeof(Tuning));
  std::set<std::string> names;
  std::set<const double*> members;
  const Tuning tuning;
  for (const TuningNumber& number : tuningNumbers()) {
    EXPECT_TRUE(names.insert(number.name).second) << number.name << " is there twice";
    EXPECT_TRUE(members.insert(&(tuning.*number.value)).second)
        << number.name << " is the member of another one";
  }
}

TEST(EvidenceTuning, EveryNumberHasAMeaningAndADefaultWithinItsRange) {
  const Tuning defaults;
  for (const TuningNumber& number : tuningNumbers()) {
    SCOPED_TRACE(number.name);
    EXPECT_LT(number.least, number.most);
    EXPECT_TRUE(std::isfinite(number.least) && std::isfinite(number.most));
    EXPECT_TRUE(number.isValid(defaults.*number.value));
    EXPECT_TRUE(!number.off || number.isValid(*number.off));
    ASSERT_FALSE(number.meaning.empty());
    EXPECT_EQ(number.meaning.back(), '.');
    EXPECT_EQ(&tuningNumber(number.name), &number);
  }
}

TEST(EvidenceTuning, WhatIsOutOfItsRangeIsRefusedInWords) {
  EXPECT_EQ(errorOfSetting("least_effect", -0.001),
            "least_effect must be from 0 to 1000 s, not -0.001");
  for (const double wrong :
       {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
        std::numeric_limits<double>::quiet_NaN()}) {
    for (const TuningNumber& number : tuningNumbers()) {
      EXPECT_EQ(errorOfSetting(number.name, wrong).find(number.name + " must be from "), 0U);
    }
  }
}

TEST(EvidenceTuning, AnUnknownNumberIsRefusedAndItIsSaidWhereAllAreNamed) {
  const std::string told =
      "the method has no number 'least'; 'info --tuning' of a model names them all";
  EXPECT_EQ(errorOfSetting("least", 1), told);
  EXPECT_EQ(problemOf([] { tuningNumber("least"); }), told);
}

TEST(EvidenceTuning, WhatWasNotSetByItsNameIsCheckedToo) {
  EXPECT_NO_THROW(Tuning{}.validate());
  for (const TuningNumber& number : tuningNumbers()) {
    Tuning tuning;
    tuning.*number.value = std::nextafter(number.most, 2 * number.most);
    EXPECT_EQ(problemOf([&] { tuning.validate(); }).find(number.name + " must be from "), 0U);
  }
}

Events robot(unsigned seed) {
  return later(followed(seed, 70 * kSecond), seed * kStart);
}

TEST(EvidenceTuning, AChannelThatIsSwitchedOffIsNotWatched) {
  const auto channels = [&](const std::set<std::string>& without) {
    Tuning tuning;
    tuning.without = without;
    std::set<std::string> watched;
    for (const Track& track :
         watch(countsOf({robot(1)}), countsOf({robot(2)}), {}, tuning).tracks) {
      watched.insert(channelName(track));
    }
    return watched;
  };
  const std::set<std::string> all = channels({});
  ASSERT_EQ(all.count(kPairs), 1U);
  for (const std::string& channel : all) {
    std::set<std::string> others = all;
    others.erase(channel);
    EXPECT_EQ(channels({channel}), others);
  }
  EXPECT_THROW(channels({kPairs, "smell"}), std::invalid_argument);
}

TEST(EvidenceTuning, EveryEndOfARangeGivesLimitsOrSaysWhyNot) {
  const Statistics first = countsOf({robot(1)});
  const Statistics second = countsOf({robot(2)});
  for (const TuningNumber& number : tuningNumbers()) {
    for (const double end : {number.least, number.most}) {
      SCOPED_TRACE(number.name + " = " + std::to_string(end));
      Tuning tuning;
      set(tuning, number.name, end);
      const auto model = std::make_shared<Model>(watch(first, second, {}, tuning));
      LimitFinder finder(model, {kWindow, 5 * kSecond});
      const std::string error = problemOf([&] {
        for (const unsigned seed : {3U, 4U}) {
          finder.startRecording(model);
          addAll(finder, robot(seed));
          finder.finish();
        }
        finder.find();
      });
      if (error.empty()) {
        EXPECT_FALSE(std::isnan(finder.find().promised_rate));
        const std::vector<double> limits = finder.find().limits.tracks;
        EXPECT_EQ(limits.size(), model->tracks().size());
        EXPECT_FALSE(std::all_of(limits.begin(), limits.end(),
                                 [](double limit) { return std::isnan(limit); }));
      }
    }
  }
}

TEST(EvidenceTuning, WithoutARecordingThereAreNoLimitsWhateverTheLeastTime) {
  Tuning tuning;
  set(tuning, "least_time", tuningNumber("least_time").least);
  const auto model =
      std::make_shared<Model>(watch(countsOf({robot(1)}), countsOf({robot(2)}), {}, tuning));
  LimitFinder finder(model, {kWindow, 5 * kSecond});
  EXPECT_THROW(finder.find(), std::invalid_argument);
}

}  // namespace
}  // namespace self_awareness::core::evidence
