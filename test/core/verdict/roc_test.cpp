#include "self_awareness/core/verdict/roc.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace self_awareness::core {
namespace {

TEST(Roc, LevelIsTheLargestCutoffWithSoFewFalsePositives) {
  const Roc roc({1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, {});
  EXPECT_EQ(roc.level(0.2).cutoff, 2.5);
  EXPECT_EQ(roc.level(0.2).false_positive_rate, 0.2);
  EXPECT_TRUE(std::isnan(roc.level(0.2).true_positive_rate));
  EXPECT_EQ(roc.level(0.05).cutoff, 1);  // eq. 5 is strict: no normal score lies below it
  EXPECT_EQ(roc.level(0.05).false_positive_rate, 0);
  EXPECT_EQ(roc.level(1).cutoff, std::numeric_limits<double>::infinity());
}

TEST(Roc, NeedsWhatItIsAskedFor) {
  EXPECT_THROW(Roc({}, {1}), std::invalid_argument);
  EXPECT_THROW(Roc({std::nan("")}, {1}), std::invalid_argument);
  const Roc normal_only({1, 2}, {});
  EXPECT_THROW(normal_only.youden(), std::logic_error);
  EXPECT_THROW(normal_only.closest(), std::logic_error);
  EXPECT_THROW(normal_only.level(-0.1), std::invalid_argument);
  EXPECT_THROW(normal_only.level(std::nan("")), std::invalid_argument);
  EXPECT_TRUE(std::isnan(normal_only.auc()));
}

}  // namespace
}  // namespace self_awareness::core
