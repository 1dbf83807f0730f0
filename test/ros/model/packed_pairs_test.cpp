#include "ros/model/packed_pairs.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

namespace self_awareness::ros1 {
namespace {

namespace evidence = core::evidence;

constexpr std::size_t kTypes = 20;

evidence::Statistics ofTypes() {
  evidence::Statistics statistics;
  for (std::size_t k = 0; k < kTypes; ++k) {
    statistics.intern({"/" + std::to_string(k), "/topic", "T"});
  }
  return statistics;
}

evidence::Statistics someCounts() {
  evidence::Statistics statistics = ofTypes();
  evidence::Partners partners;
  evidence::Partner partner;
  partner.id = 3;
  partner.answers = 200;
  partners.append(partner);
  partner.id = 4;
  partner.delays[0] = 1;
  partner.delays[7] = std::numeric_limits<std::uint32_t>::max();
  partners.append(partner);
  partner.id = 19;
  partner.answers = 0;
  partner.delays = {};
  partner.delays[evidence::kDelayBins - 1] = 128;
  partners.append(partner);
  statistics.setPartners(5, partners);
  statistics.type(5).left_out[49] = std::uint64_t{1} << 40U;
  statistics.leaveOut(0, 5);
  statistics.leaveOut(17, 5);
  return statistics;
}

TEST(PackedPairs, ComeBackAsTheyWere) {
  const evidence::Statistics counts = someCounts();
  evidence::Statistics found = ofTypes();
  for (core::EventId id = 0; id < kTypes; ++id) {
    setPairs(packedPairs(counts, id), found);
  }
  EXPECT_TRUE(found == counts);
}

TEST(PackedPairs, OfNothingAreEmpty) {
  evidence::Statistics counts = ofTypes();
  evidence::Partners partners;
  partners.makeAll(kTypes);
  counts.setPartners(5, partners);
  const self_awareness::PackedPairs message = packedPairs(counts, 5);
  EXPECT_TRUE(message.others.empty());
  EXPECT_TRUE(message.left_out.empty());
  EXPECT_TRUE(message.left_out_pairs.empty());
}

TEST(PackedPairs, ThatAreDamagedAreRefused) {
  using Message = self_awareness::PackedPairs;
  const auto error = [](const std::function<void(Message&)>& change) {
    Message message = packedPairs(someCounts(), 5);
    change(message);
    evidence::Statistics counts = ofTypes();
    try {
      setPairs(message, counts);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(error([](Message& /*message*/) {}), "");
  for (const auto change : std::vector<void (*)(Message&)>{
           [](Message& m) { m.id = kTypes; }, [](Message& m) { m.others.pop_back(); },
           [](Message& m) { m.others.push_back(0); },
           [](Message& m) { m.others.assign(1, kTypes); },
           [](Message& m) { m.others.assign(12, 0xFF); },
           [](Message& m) { m.others = {19, 0, 0, 0, 0, 0, 0, 0}; },
           [](Message& m) { m.left_out.pop_back(); },
           [](Message& m) {
             m.left_out_pairs = {0, 0, 1U << 4U};
           }}) {
    EXPECT_EQ(error(change), "its evidence does not fit its event types");
  }
  EXPECT_EQ(error([](Message& m) { m.others = {0, 0, 49, 2, 1, 1}; }),
            "its evidence has an impossible bin");
  EXPECT_EQ(error([](Message& m) {
              m.others = {5, 0, 0, 1, 1};
            }),
            "its evidence has more delays than gaps");
  EXPECT_NE(error([](Message& m) { m.left_out_pairs.at(0) = 1U << 4U; }), "")
      << "it has counts of this pair";
}

}  // namespace
}  // namespace self_awareness::ros1
