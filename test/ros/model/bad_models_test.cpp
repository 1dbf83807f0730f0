// Models that were damaged, or made to do harm: each is refused in words that name the file.

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <boost/filesystem.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "../bag/bag_bytes.h"
#include "model_file_case.h"
#include "self_awareness/PackedPairs.h"

namespace self_awareness::ros1 {
namespace {

using Message = self_awareness::Model;

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
    const std::string error = modelError(path("bad"));
    EXPECT_TRUE(error.empty() || error.rfind(path("bad") + ": ", 0) == 0) << error;
    EXPECT_EQ(error.find("memory"), std::string::npos) << error;
    return error;
  }
};

TEST_F(BadModelsTest, AModelIsRefusedWhereverItIsCut) {
  const std::string whole = plainModel();
  ASSERT_EQ(errorOf(whole), "");
  for (const std::size_t boundary : bag_bytes::boundaries(whole)) {
    for (const std::size_t cut : {boundary - 1, boundary, boundary + 1}) {
      if (cut < whole.size()) {
        EXPECT_NE(errorOf(whole.substr(0, cut)), "") << cut;
      }
    }
  }
}

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

TEST_F(BadModelsTest, AModelOfAnotherLayoutIsNoMoreBelieved) {
  std::string whole = plainModel();
  const std::string md5 = ros::message_traits::md5sum<Message>();
  for (std::size_t at = whole.find(md5); at != std::string::npos; at = whole.find(md5, at + 1)) {
    whole.replace(at, md5.size(), std::string(md5.size(), '0'));
  }
  ASSERT_EQ(errorOf(whole), "");
  std::mt19937 random(2);
  for (int round = 0; round < 1000; ++round) {
    const std::size_t at = random() % (whole.size() - sizeof(std::uint32_t));
    std::string bytes = whole;
    if (round % 2 == 0) {
      bytes[at] = static_cast<char>(bytes[at] ^ 1 << random() % 8);
    } else {
      bytes.replace(at, sizeof(std::uint32_t), bag_bytes::bytesOf(0x3FFFFFFFU));
    }
    errorOf(bytes);
  }
}

TEST_F(BadModelsTest, NumbersThatCannotBeAreRefused) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  const auto limits =
      [this](const std::function<void(self_awareness::EvidenceCalibration&)>& set) {
        return damagedModel([&](Message& m) { set(m.evidence_calibration.at(0)); });
      };
  EXPECT_EQ(limits([](auto& /*c*/) {}), "");
  for (const double limit : {-1.0, 0.0, 5e-324, 1e300, kInf, -kInf}) {
    EXPECT_NE(limits([&](auto& c) { c.limits.at(1) = limit; }), "") << limit;
  }
  EXPECT_NE(limits([&](auto& c) { c.limits.assign(c.limits.size(), kNan); }), "")
      << "nothing would ever be abnormal";
  EXPECT_NE(limits([](auto& c) { c.firsts = {1}; }), "");
  EXPECT_NE(limits([](auto& c) { c.firsts = {-2, 0}; }), "");
  EXPECT_NE(limits([](auto& c) { c.relations.pop_back(); }), "");
  EXPECT_NE(limits([](auto& c) { c.budget = -1; }), "");
}

TEST_F(BadModelsTest, WhatWouldTakeForeverIsRefused) {
  EXPECT_NE(damagedModel([](Message& m) { m.window = ros::Duration(0, 1); }), "");
  EXPECT_NE(damagedModel([](Message& m) { m.window = ros::Duration(100000, 0); }), "");
  EXPECT_EQ(damagedModel([](Message& m) { m.encoding.exclude_topics = {"(([a-z/_])*)*#"}; }), "");
  EXPECT_NE(damagedModel([](Message& m) {
              m.encoding.exclude_topics = {"(((a{1,100}){1,100}){1,100}){1,100}"};
            }),
            "");
  EXPECT_NE(damagedModel([](Message& m) {
              const self_awareness::EventType type = m.event_types.at(0);
              for (std::size_t k = 0; k <= kMostEventTypes; ++k) {
                m.event_types.push_back(type);
                m.event_types.back().scope = "/" + std::to_string(k);
              }
            }),
            "");
}

TEST_F(BadModelsTest, TimesThatWouldRunOverAreRefused) {
  // A fuzzer's: the core multiplies the latest first event.
  constexpr std::int64_t kLong = 9079256848778919936;
  EXPECT_NE(
      damagedModel([](Message& m) { m.watched.at(0).recordings.at(0).firsts.at(0) = kLong; }), "");
  EXPECT_NE(damagedModel([](Message& m) {
              m.evidence_calibration.at(0).firsts = {kLong, 0};
            }),
            "");
  EXPECT_NE(damagedModel([](Message& m) { m.watched.at(1).longest_gaps.at(0) = kLong; }), "");
  EXPECT_NE(damagedModel([](Message& m) { m.watched.at(0).duration = kLong; }), "");
  EXPECT_NE(damagedModel([](Message& m) { m.watched.at(0).gap_sums.at(0) = kLong; }), "");
  EXPECT_NE(damagedModel([](Message& m) { m.watched.at(0).gaps.at(0) = ~std::uint64_t{0}; }), "");
  EXPECT_NE(damagedModel([](Message& m) { m.watched.at(0).gaps.at(0) = 1; }), "")
      << "more delays than gaps";
  EXPECT_NE(damagedModel([](Message& m) { m.findings.at(0).longest_gaps.at(0) = kLong; }), "");
}

TEST_F(BadModelsTest, WhatContradictsItselfIsRefused) {
  const ros::Time late(2000000000, 0);
  EXPECT_NE(damagedModel([&](Message& m) { m.recordings.at(0).start = late; }), "");
  EXPECT_NE(damagedModel([&](Message& m) { m.findings.at(0).start = late; }), "");
  EXPECT_NE(damagedModel([&](Message& m) { m.watched.at(0).recordings.at(0).start = late; }), "");
  EXPECT_NE(damagedModel(
                [&](Message& m) { m.evidence_calibration.at(0).recordings.at(0).start = late; }),
            "");
  EXPECT_NE(damagedModel([](Message& m) { ++m.findings.at(1).windows; }), "");
  EXPECT_NE(damagedModel([](Message& m) { m.findings.at(0).evidence.at(0) = -1; }), "");
  EXPECT_NE(damagedModel(
                [](Message& m) { m.watched.at(0).gaps.at(0) = m.watched.at(0).events.at(0) + 1; }),
            "");
  for (const double spread : {-0.5, 1.5, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_NE(damagedModel([&](Message& m) {
                m.evidence_calibration.at(0).relations.at(1).spread = spread;
              }),
              "")
        << spread;
  }
}

TEST_F(BadModelsTest, WhatIsThereTwiceIsRefused) {
  EXPECT_NE(damagedModel([](Message& m) { m.tracks.at(1) = m.tracks.at(0); }), "");
  EXPECT_NE(damagedModel([](Message& m) {
              m.tuning.names.push_back(m.tuning.names.at(0));
              m.tuning.values.push_back(m.tuning.values.at(0));
            }),
            "");
  EXPECT_NE(damagedModel([](Message& m) {
              m.encoding.type_fields.push_back(m.encoding.type_fields.at(0));
            }),
            "");
  EXPECT_NE(damagedModel([](Message& m) {
              self_awareness::GraphEdge edge;
              edge.publisher = "/a";
              edge.topic = "/x";
              edge.subscriber = "/b";
              m.graph = {edge, edge};
            }),
            "");
}

TEST_F(BadModelsTest, CountsThatAreNotInOrderAreRefused) {
  const auto swapped = [](auto& message) { message.id = 1 - message.id; };
  EXPECT_NE(damagedMessages<self_awareness::PackedPairs>("/evidence/first", swapped), "");
  EXPECT_NE(damagedMessages<self_awareness::PackedPairs>("/evidence/second",
                                                         [](auto& message) { message.id = 0; }),
            "");
}

TEST_F(BadModelsTest, WhatAnotherProgramChangedIsRefused) {
  saveModel(calibratedModel(), path("whole"));
  for (const std::string& topic :
       {std::string("/version"), std::string("/model"), std::string("/evidence/first"),
        std::string("/evidence/second")}) {
    const rosbag::Bag whole(path("whole"), rosbag::bagmode::Read);
    rosbag::Bag changed(path("changed"), rosbag::bagmode::Write);
    for (const rosbag::MessageInstance& message : rosbag::View(whole)) {
      if (message.getTopic() == "/version" && topic == "/version") {
        const auto version = message.instantiate<self_awareness::FileVersion>();
        version->method = 1;
        changed.write(topic, message.getTime(), *version);
      } else if (message.getTopic() == "/model" && topic == "/model") {
        const auto model = message.instantiate<Message>();
        std::swap(model->findings.at(0), model->findings.at(1));
        changed.write(topic, message.getTime(), *model);
      } else if (message.getTopic() == "/evidence/first" && topic == "/evidence/first") {
        const auto pairs = message.instantiate<self_awareness::PackedPairs>();
        ++pairs->others.at(0);
        changed.write(topic, message.getTime(), *pairs);
      } else if (message.getTopic() != topic) {
        changed.write(message.getTopic(), message.getTime(), message);
      }
    }
    changed.close();
    EXPECT_EQ(modelError(path("changed")).rfind(path("changed") + ": ", 0), 0U) << topic;
  }
}

TEST_F(BadModelsTest, NoModelIsWrittenThatCannotBeRead) {
  TrainedModel model = calibratedModel();
  model.recordings.at(0).bag = "a\x1B[2J.bag";
  try {
    saveModel(model, path("unreadable"));
    FAIL();
  } catch (const ModelFileError& error) {
    EXPECT_EQ(std::string(error.what()).rfind(path("unreadable") + ": ", 0), 0U) << error.what();
  }
  EXPECT_FALSE(boost::filesystem::exists(path("unreadable")));
}

TEST_F(BadModelsTest, TextsThatNoTerminalShouldGetAreRefused) {
  EXPECT_NE(damagedModel([](Message& m) { m.recordings.at(0).bag = "a\x1B[2J.bag"; }), "");
  EXPECT_NE(damagedModel([](Message& m) {
              m.event_types.at(0).source =
                  "/a\xE2\x80\xAE"
                  "b";
            }),
            "");
  EXPECT_NE(damagedModel([](Message& m) { m.evidence_calibration.at(0).method = "a\rb"; }), "");
  EXPECT_NE(damagedModel([](Message& m) { m.encoding.exclude_topics = {"a\x07"}; }), "");
  EXPECT_NE(damagedModel([](Message& m) { m.event_types.at(0).source = "/m\xFCller"; }), "");
  EXPECT_NE(damagedModel([](Message& m) { m.recordings.at(0).bag = "gr\xFC\xDF.bag"; }), "");
}

}  // namespace
}  // namespace self_awareness::ros1
