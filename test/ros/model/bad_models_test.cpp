// Models that were damaged, or made to do harm: each is refused in words that name the file.

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <boost/filesystem.hpp>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "../../times.h"
#include "../bag/bag_bytes.h"
#include "model_file_case.h"

namespace self_awareness::ros1 {
namespace {

class BadModelsTest : public ModelFileTest {
 protected:
  /// A model without compression: each byte of it means something.
  std::string plainModel() {
    saveModel(calibratedModel(), path("packed"));
    const rosbag::Bag packed(path("packed"), rosbag::bagmode::Read);
    rosbag::Bag plain(path("plain"), rosbag::bagmode::Write);
    for (const rosbag::MessageInstance& message : rosbag::View(packed)) {
      plain.write(message.getTopic(), message.getTime(), message);
    }
    plain.close();
    return bag_bytes::readFile(path("plain"));
  }
  std::string errorOf(const std::string& bytes) {
    bag_bytes::writeFile(path("bad"), bytes);
    std::string error = modelError(path("bad"));
    EXPECT_TRUE(error.empty() || begins(error, path("bad") + ": "));
    EXPECT_FALSE(has(error, "memory")) << error;
    return error;
  }
};

TEST_F(BadModelsTest, AFlippedBitOrALyingLengthAsksForNoMemory) {
  const std::string whole = plainModel();
  const std::size_t first = bag_bytes::boundaries(whole)[1];
  std::mt19937 random(1);
  for (int round = 0; round < 1500; ++round) {
    const std::size_t at = first + random() % (whole.size() - first - sizeof(std::uint32_t));
    std::string bytes = whole;
    if (round % 2 == 0) {
      bytes[at] = static_cast<char>(bytes[at] ^ 1 << random() % 8);
    } else {
      bytes.replace(at, sizeof(std::uint32_t),
                    bag_bytes::bytesOf(round % 4 == 1 ? 0xFFFFFFF0U : 0x3FFFFFFFU));
    }
    errorOf(bytes);
  }
}

TEST_F(BadModelsTest, NumbersThatCannotBeAreRefused) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  const auto error = [this](const std::function<void(core::Calibration&)>& set) {
    return damagedModel([&](TrainedModel& m) { set(*m.calibration); });
  };
  for (const double limit : {-1.0, 0.0, 5e-324, 1e300, kInf, -kInf}) {
    EXPECT_NE(error([&](auto& c) { c.limits.tracks.at(1) = limit; }), "") << limit;
  }
  EXPECT_NE(error([&](auto& c) { c.limits.tracks.assign(c.limits.tracks.size(), kNan); }), "")
      << "nothing would ever be abnormal";
  EXPECT_NE(error([](auto& c) { c.limits.firsts = {1}; }), "");
  EXPECT_NE(error([](auto& c) { c.limits.firsts = {-2, 0}; }), "");
  EXPECT_NE(error([](auto& c) { c.relations.pop_back(); }), "");
  EXPECT_NE(error([](auto& c) { c.budget = -1; }), "");
  for (const double spread : {-0.5, 1.5, kNan}) {
    EXPECT_NE(error([&](auto& c) { c.relations.at(1).spread = spread; }), "") << spread;
  }
  EXPECT_NE(
      damagedModel([](TrainedModel& m) { m.findings.at(0).parts.at(0).evidence.at(0) = -1; }), "");
  EXPECT_NE(damagedModel([](TrainedModel& m) { m.paper_calibration.emplace().threshold = kNan; }),
            "");
  EXPECT_NE(damagedPart("/model", [](std::vector<std::uint8_t>& bytes) { bytes.push_back(0); }),
            "");
}

TEST_F(BadModelsTest, PartsThatDoNotFitEachOtherAreRefused) {
  const auto error = [this](const std::function<void(TrainedModel&)>& change) {
    return damagedModel(change);
  };
  const std::string file = path("damaged") + ": a damaged model file: ";
  const std::string findings = file + "its findings do not fit its tracks";
  EXPECT_EQ(error([](auto& m) { m.findings.at(1).parts.at(0).evidence.pop_back(); }), findings);
  EXPECT_EQ(error([](auto& m) { m.findings.at(1).parts.at(0).longest_gaps = {1}; }), findings);
  EXPECT_EQ(error([](auto& m) { m.findings.at(1).said.pop_back(); }), findings);
  EXPECT_EQ(error([](auto& m) { m.findings.at(0).said.at(0) = core::evidence::Said{3}; }),
            file + "its findings say what this version does not know");
  for (const std::size_t tracks : {0, 1, 1000}) {
    EXPECT_TRUE(begins(error([&](auto& m) { m.calibration->limits.tracks.assign(tracks, 1); }),
                       file + "its limits are not those of its evidence"));
  }
  EXPECT_EQ(error([](auto& m) { m.watched.tracks.at(0).to = 2; }),
            file + "it watches an event type that it does not have");
  EXPECT_EQ(error([](auto& m) { m.tuning.least_effect = -0.001; }),
            file + "least_effect must be from 0 to 1000 s, not -0.001");
  EXPECT_NE(error([](auto& m) { m.statistics = core::paper::DelayStatistics({}); }), "");
}

TEST_F(BadModelsTest, WhatWouldTakeForeverIsRefused) {
  for (const std::int64_t window :
       {-kSecond, std::int64_t{0}, std::int64_t{1}, 100000 * kSecond}) {
    EXPECT_NE(damagedModel([&](TrainedModel& m) { m.window = window; }), "") << window;
  }
  const auto excluding = [this](const std::string& pattern) {
    return damagedModel([&](TrainedModel& m) { m.encoding.exclude_topics = {pattern}; });
  };
  EXPECT_EQ(excluding("(([a-z/_])*)*#"), "");
  EXPECT_NE(excluding("("), "");
  EXPECT_NE(excluding("(((a{1,100}){1,100}){1,100}){1,100}"), "");
  EXPECT_NE(damagedModel([](TrainedModel& m) {
              for (std::size_t k = 0; k <= kMostEventTypes; ++k) {
                m.statistics.intern({"/a", "/" + std::to_string(k), "T"});
              }
            }),
            "");
}

TEST_F(BadModelsTest, TimesAndCountsThatWouldRunOverAreRefused) {
  // A fuzzer's: the core multiplies the latest first event.
  constexpr std::int64_t kLong = 9079256848778919936;
  const auto ofType = [this](void (*change)(core::evidence::Statistics::Type&)) {
    return damagedModel([&](TrainedModel& m) { change(m.watched.halves[0].type(0)); });
  };
  EXPECT_NE(ofType([](auto& type) { type.longest_gaps.at(0) = kLong; }), "");
  EXPECT_NE(ofType([](auto& type) { type.gap_sum = kLong; }), "");
  EXPECT_NE(ofType([](auto& type) { type.gap_sum = -1; }), "");
  EXPECT_NE(ofType([](auto& type) { type.gaps = ~std::uint64_t{0}; }), "");
  EXPECT_NE(ofType([](auto& type) { type.gaps = 0; }), "");
  EXPECT_NE(ofType([](auto& type) { type.gaps = 1; }), "") << "more delays than gaps";
  EXPECT_NE(ofType([](auto& type) { type.gaps = type.events + 1; }), "");
  EXPECT_NE(ofType([](auto& type) { type.longest_gaps.assign(33, 1); }), "");
  EXPECT_NE(ofType([](auto& type) { type.longest_gaps.push_back(kSecond); }), "") << "no order";
  EXPECT_NE(damagedModel([](TrainedModel& m) { m.watched.halves[0].addDuration(kLong); }), "");
  EXPECT_NE(damagedModel([](TrainedModel& m) { m.watched.halves[0].addDuration(-kLong); }), "");
  EXPECT_NE(damagedModel([](TrainedModel& m) { m.calibration->limits.firsts = {kLong, 0}; }), "");
  EXPECT_NE(damagedModel(
                [](TrainedModel& m) { m.findings.at(0).parts.at(0).longest_gaps.at(0) = kLong; }),
            "");
}

TEST_F(BadModelsTest, RecordingsThatCannotBeAreRefused) {
  const auto error = [this](void (*change)(core::evidence::Statistics::Recording&)) {
    return damagedModel([&](TrainedModel& m) {
      core::evidence::Statistics::Recording recording = m.watched.halves[0].recordings().at(0);
      change(recording);
      m.watched.halves[0].addRecording(recording);
    });
  };
  EXPECT_EQ(error([](auto& /*recording*/) {}), "");
  EXPECT_NE(error([](auto& recording) { recording.events.push_back(1); }), "");
  EXPECT_NE(error([](auto& recording) { recording.firsts.at(0) = kSecond << 30; }), "");
  EXPECT_NE(error([](auto& recording) { recording.longest_stall = -1; }), "");
  EXPECT_NE(error([](auto& recording) { recording.end = (std::int64_t{1} << 62U) + 1; }), "");
  EXPECT_NE(damagedModel([](TrainedModel& m) { ++m.findings.at(1).windows; }), "");
}

TEST_F(BadModelsTest, WhatIsThereTwiceIsRefused) {
  EXPECT_NE(damagedModel([](TrainedModel& m) { m.watched.tracks.at(1) = m.watched.tracks.at(0); }),
            "");
  EXPECT_NE(damagedPart("/model", rename("fewest_gaps", "busy_one_in")), "");
}

TEST_F(BadModelsTest, WhatAnotherProgramChangedIsRefused) {
  saveModel(calibratedModel(), path("whole"));
  for (const char* topic : {"/version", "/model", "/evidence/first", "/evidence/second"}) {
    const rosbag::Bag whole(path("whole"), rosbag::bagmode::Read);
    rosbag::Bag changed(path("changed"), rosbag::bagmode::Write);
    for (const rosbag::MessageInstance& message : rosbag::View(whole)) {
      if (message.getTopic() != topic) {
        changed.write(message.getTopic(), message.getTime(), message);
      } else if (const auto version = message.instantiate<self_awareness::FileVersion>()) {
        version->method = 1;
        changed.write(topic, message.getTime(), *version);
      } else if (const auto part = message.instantiate<self_awareness::ModelPart>()) {
        part->bytes.at(0) ^= 1U;
        changed.write(topic, message.getTime(), *part);
      }
    }
    changed.close();
    EXPECT_TRUE(begins(modelError(path("changed")), path("changed") + ": ")) << topic;
  }
}

TEST_F(BadModelsTest, NoModelIsWrittenThatCannotBeRead) {
  TrainedModel model = calibratedModel();
  model.recordings.at(0).bag = "a\x1B[2J.bag";
  EXPECT_TRUE(begins(problemOf<ModelFileError>([&] { saveModel(model, path("unreadable")); }),
                     path("unreadable") + ": "));
  EXPECT_FALSE(boost::filesystem::exists(path("unreadable")));
}

}  // namespace
}  // namespace self_awareness::ros1
