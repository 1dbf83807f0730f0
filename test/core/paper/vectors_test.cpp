// Checks every case of vectors.json; its values were computed by hand.

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/paper/delay_trainer.h"
#include "core/paper/scorer.h"
#include "self_awareness/core/paper/delay_statistics.h"
#include "self_awareness/core/paper/judge.h"
#include "self_awareness/core/paper/model.h"
#include "self_awareness/core/verdict/detector.h"
#include "self_awareness/core/verdict/roc.h"

namespace self_awareness::core::paper {
namespace {

using nlohmann::json;

constexpr double kExact = 1e-14;
constexpr std::int64_t kMillisecond = 1000000;

std::string sharedFolder() {
  const char* folder = std::getenv("SELF_AWARENESS_SHARED");
  return folder != nullptr ? folder : SELF_AWARENESS_SHARED;
}

// Exact values are fractions such as "2/15".
double value(const json& number) {
  if (number.is_number()) {
    return number.get<double>();
  }
  const std::string text = number.get<std::string>();
  const std::size_t slash = text.find('/');
  return std::stod(text.substr(0, slash)) / std::stod(text.substr(slash + 1));
}

EventType typeOf(const std::string& name) {
  return {"/node", "/" + name, "test/Type"};
}

class Vectors : public testing::Test {
 protected:
  void SetUp() override {
    std::ifstream file(sharedFolder() + "/vectors.json");
    if (!file) {
      GTEST_SKIP() << sharedFolder() << "/vectors.json is absent";
    }
    file >> vectors_;
    ASSERT_EQ(vectors_["cases"].size(), 3U);
  }

  static DelayStatistics train(const json& test_case) {
    const Binning binning{test_case["bin_ms"].get<std::int64_t>() * kMillisecond,
                          test_case.value("horizon_bins", std::int64_t{0})};
    DelayStatistics statistics(binning);
    DelayTrainer trainer(statistics);
    for (const json& bag : test_case["train_bags"]) {
      trainer.startRecording();
      for (const json& event : bag) {
        const EventId id = statistics.intern(typeOf(event[1].get<std::string>()));
        trainer.add({event[0].get<std::int64_t>() * kMillisecond, id});
      }
    }
    return statistics;
  }

  // The events of the test recording; those that the model does not know get the next ids.
  static std::vector<Event> testEvents(const json& test_case, const Model& model) {
    Vocabulary vocabulary = model.vocabulary();
    std::vector<Event> events;
    for (const json& event : test_case["test"]) {
      events.push_back({event[0].get<std::int64_t>() * kMillisecond,
                        vocabulary.intern(typeOf(event[1].get<std::string>()))});
    }
    return events;
  }

  template <typename Check>
  static void forEachPair(const json& pairs, const Vocabulary& vocabulary, Check check) {
    ASSERT_FALSE(pairs.empty());
    for (const auto& [names, expected] : pairs.items()) {
      SCOPED_TRACE(names);
      const auto from = vocabulary.find(typeOf(names.substr(0, names.find('>'))));
      const auto to = vocabulary.find(typeOf(names.substr(names.find('>') + 1)));
      ASSERT_TRUE(from && to);
      check(*from, *to, expected);
    }
  }

  json vectors_;
};

TEST_F(Vectors, CountsEntropiesAndWeights) {
  for (const json& test_case : vectors_["cases"]) {
    SCOPED_TRACE(test_case["name"].get<std::string>());
    const DelayStatistics statistics = train(test_case);
    const Model model(statistics);
    forEachPair(test_case["counts"], model.vocabulary(),
                [&](EventId from, EventId to, const json& expected) {
                  std::map<std::string, std::uint64_t> counts;
                  for (const Histogram::Entry& entry : statistics.pair(from, to).entries()) {
                    counts[std::to_string(entry.bin)] = entry.count;
                  }
                  EXPECT_EQ(counts, (expected.get<std::map<std::string, std::uint64_t>>()));
                });
    forEachPair(test_case["entropy_bits"], model.vocabulary(),
                [&](EventId from, EventId to, const json& expected) {
                  EXPECT_NEAR(model.entropy(from, to), value(expected), kExact);
                });
    forEachPair(test_case["weights_all_tracked"], model.vocabulary(),
                [&](EventId from, EventId to, const json& expected) {
                  EXPECT_NEAR(model.weight(from, to), value(expected), kExact);
                });
  }
}

TEST_F(Vectors, EventScores) {
  for (const json& test_case : vectors_["cases"]) {
    SCOPED_TRACE(test_case["name"].get<std::string>());
    const auto model = std::make_shared<const Model>(train(test_case));
    Scorer scorer(model);
    const std::vector<Event> events = testEvents(test_case, *model);
    ASSERT_EQ(events.size(), test_case["event_scores"].size());
    for (std::size_t i = 0; i < events.size(); ++i) {
      EXPECT_NEAR(scorer.score(events[i]).score, value(test_case["event_scores"][i]), kExact) << i;
    }
  }
}

TEST_F(Vectors, WindowsAndVerdicts) {
  for (const json& test_case : vectors_["cases"]) {
    SCOPED_TRACE(test_case["name"].get<std::string>());
    const auto model = std::make_shared<const Model>(train(test_case));
    const std::int64_t length = test_case["window_ms"].get<std::int64_t>() * kMillisecond;
    std::vector<std::int64_t> abnormal;
    std::size_t i = 0;
    Detector detector(makeJudge(model, value(test_case["threshold"]), true), length,
                      Detector::Parameters(), [&](const Verdict& verdict) {
                        ASSERT_LT(i, test_case["windows"].size());
                        const json& expected = test_case["windows"][i++];
                        const std::int64_t k = verdict.window->start / length;
                        EXPECT_EQ(k, expected["k"].get<std::int64_t>());
                        EXPECT_EQ(verdict.window->events.size(), expected["n"].get<std::size_t>());
                        ASSERT_EQ(verdict.score.has_value(), !expected["score"].is_null());
                        if (verdict.score) {
                          EXPECT_NEAR(*verdict.score, value(expected["score"]), kExact);
                        }
                        if (verdict.abnormal) {
                          abnormal.push_back(k);
                        }
                      });
    for (const Event& event : testEvents(test_case, *model)) {
      detector.add(event);
    }
    detector.finish();
    EXPECT_EQ(i, test_case["windows"].size());
    EXPECT_EQ(json(abnormal), test_case["abnormal_windows_empty_as_zero"]);
  }
}

TEST_F(Vectors, Roc) {
  ASSERT_FALSE(vectors_["roc"].empty());
  for (const json& test_case : vectors_["roc"]) {
    const Roc roc(test_case["normal"].get<std::vector<double>>(),
                  test_case["abnormal"].get<std::vector<double>>());
    EXPECT_NEAR(roc.auc(), value(test_case["auc"]), kExact);
    EXPECT_EQ(roc.youden().cutoff, value(test_case["youden_cut"]));
    EXPECT_EQ(roc.closest().cutoff, value(test_case["closest_cut"]));
  }
}

}  // namespace
}  // namespace self_awareness::core::paper
