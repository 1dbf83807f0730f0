#include "self_awareness/core/paper/model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "core/paper/delay_trainer.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::paper {
namespace {

constexpr std::int64_t kMillisecond = 1000000;
constexpr std::int64_t kSecond = 1000 * kMillisecond;

TEST(PaperModel, ATypeWithFewGapsHasNoOpinion) {
  DelayStatistics statistics(Binning{10 * kMillisecond, 0});
  const EventId rare = statistics.intern({"/player", "/scan", "sensor_msgs/LaserScan"});
  const EventId common = statistics.intern({"/slam", "/pose", "geometry_msgs/PoseStamped"});
  DelayTrainer trainer(statistics);
  for (std::uint64_t i = 0; i <= kFewestGaps; ++i) {
    trainer.add({static_cast<std::int64_t>(i) * kSecond, common});
    if (i < kFewestGaps) {
      trainer.add({static_cast<std::int64_t>(i) * kSecond, rare});
    }
  }
  const Model model(statistics);
  EXPECT_EQ(model.logSurvival(rare, 3600 * kSecond), 0);
  // The tail adds one virtual gap to 30 of 1 s: 1.01 s is the upper edge of the longest gap's bin.
  EXPECT_NEAR(model.logSurvival(common, 2 * kSecond), -2 / 1.01 - std::log(31), 1e-12);
  EXPECT_NEAR(model.logSurvival(common, kSecond),
              std::log(30 + std::exp(-1 / 1.01)) - std::log(31), 1e-12);
}

}  // namespace
}  // namespace self_awareness::core::paper
