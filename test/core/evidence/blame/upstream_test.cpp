#include "core/evidence/blame/upstream.h"

#include <gtest/gtest.h>

#include <memory>

namespace self_awareness::core::evidence {
namespace {

constexpr std::size_t kSlam = 0;
constexpr std::size_t kLaser = 1;
constexpr std::size_t kArm = 2;

class UpstreamTest : public testing::Test {
 protected:
  std::shared_ptr<SourceGraph> graph_ = std::make_shared<SourceGraph>();
  Upstream upstream_{{"/slam", "/laser", "/arm"}, graph_};
};

TEST_F(UpstreamTest, WithoutAGraphNobodyIs) {
  EXPECT_TRUE(upstream_.empty());
  EXPECT_FALSE(upstream_.isUpstream(kLaser, kSlam));
}

TEST_F(UpstreamTest, ComponentsHaveTheNumbersOfTheirPlaces) {
  graph_->connect("/laser", "/scan", "/filter");  // that is no component of the model
  graph_->connect("/filter", "/scan_filtered", "/slam");
  EXPECT_FALSE(upstream_.empty());
  EXPECT_TRUE(upstream_.isUpstream(kLaser, kSlam));
  EXPECT_FALSE(upstream_.isUpstream(kSlam, kLaser));
  EXPECT_FALSE(upstream_.isUpstream(kLaser, kArm));
}

TEST_F(UpstreamTest, WhatTheGraphLearnsLaterCounts) {
  graph_->connect("/laser", "/scan", "/slam");
  ASSERT_FALSE(upstream_.isUpstream(kSlam, kArm));
  graph_->connect("/slam", "/pose", "/arm");
  EXPECT_TRUE(upstream_.isUpstream(kSlam, kArm));
  EXPECT_TRUE(upstream_.isUpstream(kLaser, kArm));
}

}  // namespace
}  // namespace self_awareness::core::evidence
