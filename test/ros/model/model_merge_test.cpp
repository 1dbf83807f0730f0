#include "self_awareness/ros/model/model_merge.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <set>
#include <stdexcept>
#include <string>

#include "../../problem.h"
#include "core/paper/delay_trainer.h"
#include "self_awareness/core/evidence/count/trainer.h"

namespace self_awareness::ros1 {
namespace {

using Types = std::vector<core::EventType>;

const core::EventType kScan{"/a", "/scan", "T"};
const core::EventType kMap{"/b", "/map", "T"};
const core::EventType kPose{"/b", "/pose", "T[status=1]"};

// Counts each event type in turn, 40 ms apart, from a time on, into one of the halves.
void trainOn(TrainedModel& model, const Types& types, std::int64_t start, std::size_t half) {
  core::paper::DelayTrainer trainer(model.statistics);
  core::evidence::Trainer evidence(model.evidence.at(half), model.window);
  for (int i = 0; i < 200; ++i) {
    const core::EventType& type = types[static_cast<std::size_t>(i) % types.size()];
    const core::EventId id = model.statistics.intern(type);
    for (core::evidence::Statistics& statistics : model.evidence) {
      statistics.intern(type);
    }
    const core::Event event{start + i * (40000000LL + start / 1000), id};
    trainer.add(event);
    evidence.add(event);
  }
  evidence.finish();
  core::RecordingInfo recording;
  recording.fingerprint = static_cast<std::uint64_t>(start);
  model.recordings.push_back(recording);
}

class ModelMergeTest : public testing::Test {
 protected:
  ModelMergeTest() {
    for (TrainedModel* model : {&first_, &second_, &both_}) {
      model->encoding = EncodingRules::defaults();
      model->statistics = core::paper::DelayStatistics(core::paper::Binning{5000000, 20});
    }
    trainOn(first_, {kScan, kMap}, 1000, 0);
    trainOn(second_, {kMap, kPose, kScan}, 7001, 1);
    trainOn(both_, {kScan, kMap}, 1000, 0);
    trainOn(both_, {kMap, kPose, kScan}, 7001, 1);
  }

  std::string errorOf(const std::function<void(TrainedModel&)>& change) const {
    TrainedModel model = first_;
    TrainedModel other = second_;
    change(other);
    std::string error = problemOf([&] { merge(model, other); });
    if (!error.empty()) {
      EXPECT_TRUE(model.statistics == first_.statistics);
      EXPECT_TRUE(model.evidence == first_.evidence);
      EXPECT_EQ(model.recordings.size(), 1U);
    }
    return error;
  }

  TrainedModel first_;
  TrainedModel second_;
  TrainedModel both_;
};

TEST_F(ModelMergeTest, WhatWasLearnedUnderOtherNamesIsRenamed) {
  TrainedModel numbered = first_;
  numbered.statistics = core::paper::DelayStatistics(first_.statistics.binning());
  numbered.evidence = {};
  numbered.recordings.clear();
  trainOn(numbered, {{"/a_17", "/scan", "T"}, kMap}, 1000, 0);
  numbered.graph.connect("/a_17", "/scan", "/b");
  rename(numbered, {{"/a_[0-9]+(/.*)?", "/a\\1"}});
  EXPECT_EQ(numbered.vocabulary().types(), first_.vocabulary().types());
  EXPECT_TRUE(numbered.graph.edges() ==
              (std::set<core::SourceGraph::Edge>{{"/a", "/scan", "/b"}}));
  EXPECT_EQ(numbered.encoding.renames.size(), 1U);
  second_.encoding = numbered.encoding;
  both_.encoding = numbered.encoding;
  merge(numbered, second_);
  EXPECT_TRUE(numbered.statistics == both_.statistics);
  EXPECT_TRUE(numbered.evidence[0] == both_.evidence[0]);
  EXPECT_THROW(rename(first_, {{".*", "/one"}}), std::invalid_argument);
}

TEST_F(ModelMergeTest, SaysWhatDoesNotFitAndLeavesTheModelAsItWas) {
  EXPECT_EQ(errorOf([](TrainedModel& /*model*/) {}), "");
  const auto bins = [](std::int64_t size, std::int64_t horizon) {
    return [size, horizon](TrainedModel& model) {
      model.statistics = core::paper::DelayStatistics(core::paper::Binning{size, horizon});
    };
  };
  EXPECT_EQ(errorOf(bins(5000001, 20)), "another bin size: 0.005000001 s, not 0.005 s");
  EXPECT_EQ(errorOf(bins(5000000, 0)), "another horizon: none, not 0.1 s");
  EXPECT_EQ(errorOf([](TrainedModel& model) { model.window = 200000000; }),
            "another length of the windows: 0.2 s, not 0.1 s");
  using Change = std::function<void(EncodingRules&)>;
  for (const auto& [part, change] : std::map<std::string, Change>{
           {"source", [](auto& rules) { rules.source = EncodingRules::Source::kNone; }},
           {"include_topics", [](auto& rules) { rules.include_topics = {"/x"}; }},
           {"exclude_topics", [](auto& rules) { rules.exclude_topics = {"/x"}; }},
           {"include_sources", [](auto& rules) { rules.include_sources = {"/x"}; }},
           {"exclude_sources", [](auto& rules) { rules.exclude_sources.clear(); }},
           {"type_fields", [](auto& rules) { rules.type_fields["T"] = "status"; }}}) {
    EXPECT_EQ(errorOf([change = change](TrainedModel& model) { change(model.encoding); }),
              "another encoding: " + part + " differs");
  }
}

TEST_F(ModelMergeTest, AFieldHasOnlySoManyValuesTogether) {
  const auto withValues = [this](std::size_t from, std::size_t to) {
    return [this, from, to](TrainedModel& model) {
      model.statistics = core::paper::DelayStatistics(first_.statistics.binning());
      for (std::size_t i = from; i < to; ++i) {
        model.statistics.intern({"", "/x", "T[status=" + std::to_string(i) + "]"});
      }
    };
  };
  first_.encoding.type_fields["T"] = "status";
  second_.encoding.type_fields["T"] = "status";
  withValues(0, 600)(first_);
  EXPECT_EQ(errorOf(withValues(100, kMostTypesOfField)), "");
  EXPECT_TRUE(begins(errorOf(withValues(600, kMostTypesOfField + 1)),
                     "the type field T: status has more than 1000 values"));
}

TEST_F(ModelMergeTest, BytesOfAnotherVersionOrHalfOfThemAreRefused) {
  std::string bytes = toBytes(both_);
  EXPECT_THROW(fromBytes(bytes.substr(0, bytes.size() / 2)), std::invalid_argument);
  EXPECT_THROW(fromBytes(""), std::invalid_argument);
  bytes[0] = bytes[0] == '0' ? '1' : '0';
  EXPECT_THROW(fromBytes(bytes), std::invalid_argument);
}

}  // namespace
}  // namespace self_awareness::ros1
