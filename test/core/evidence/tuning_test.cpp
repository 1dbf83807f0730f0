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
#include "recordings.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/evidence/channel/watched.h"
#include "self_awareness/core/evidence/limits/limits.h"

namespace self_awareness::core::evidence {
namespace {

std::string errorOfSetting(const std::string& name, double value) {
  Tuning tuning;
  std::string error = problemOf([&] { set(tuning, name, value); });
  EXPECT_EQ(tuning == Tuning{}, !error.empty()) << "what is refused changes nothing";
  return error;
}

TEST(EvidenceTuning, EveryMemberIsInTheTableWithAMeaningAndADefaultWithinItsRange) {
  // Without a number in the table, a model file would not keep it.
  // NOLINTNEXTLINE(bugprone-sizeof-container): how large the member is, not what it holds
  EXPECT_EQ(tuningNumbers().size() * sizeof(double) + sizeof(Tuning::without), sizeof(Tuning));
  std::set<const double*> members;
  const Tuning tuning;
  for (const TuningNumber& number : tuningNumbers()) {
    SCOPED_TRACE(number.name);
    EXPECT_EQ(&tuningNumber(number.name), &number) << "the name is there twice";
    EXPECT_TRUE(members.insert(&(tuning.*number.value)).second) << "the member of another one";
    EXPECT_LT(number.least, number.most);
    EXPECT_TRUE(std::isfinite(number.least) && std::isfinite(number.most));
    EXPECT_TRUE(number.isValid(tuning.*number.value));
    EXPECT_TRUE(!number.off || number.isValid(*number.off));
    ASSERT_FALSE(number.meaning.empty());
    EXPECT_EQ(number.meaning.back(), '.');
  }
}

TEST(EvidenceTuning, WhatIsOutOfItsRangeOrUnknownIsRefusedInWords) {
  EXPECT_EQ(errorOfSetting("least_effect", -0.001),
            "least_effect must be from 0 to 1000 s, not -0.001");
  const std::string told =
      "the method has no number 'least'; 'info --tuning' of a model names them all";
  EXPECT_EQ(errorOfSetting("least", 1), told);
  EXPECT_EQ(problemOf([] { tuningNumber("least"); }), told);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const TuningNumber& number : tuningNumbers()) {
    const std::string refused = number.name + " must be from ";
    for (const double wrong : {infinity, -infinity, std::nan("")}) {
      EXPECT_TRUE(begins(errorOfSetting(number.name, wrong), refused));
    }
    Tuning tuning;  // what was not set by its name is checked, too
    tuning.*number.value = std::nextafter(number.most, infinity);
    EXPECT_TRUE(begins(problemOf([&] { tuning.validate(); }), refused));
  }
  EXPECT_NO_THROW(Tuning{}.validate());
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
      std::string error = problemOf([&] {
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

}  // namespace
}  // namespace self_awareness::core::evidence
