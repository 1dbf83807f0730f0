#include "monitor/restart_watch.h"

#include <gtest/gtest.h>

#include "../times.h"

namespace self_awareness {
namespace {

using Nodes = std::vector<std::string>;
using Addresses = std::map<std::string, std::string>;

ros1::Encoder encoder(const std::vector<ros1::Rename>& renames = {}) {
  ros1::EncodingRules rules = ros1::EncodingRules::defaults();
  rules.renames = renames;
  return ros1::Encoder(rules, [](const core::EventType&) { return core::EventId{0}; });
}

Nodes see(Restarts& restarts, const Addresses& addresses, std::int64_t now,
          const std::string& when) {
  return restarts.see(addresses, encoder(), now, when);
}

TEST(Restarts, AnotherAddressIsARestartAndTheLineComesWhenAllIsAsUsual) {
  Restarts restarts(5 * kSecond);
  EXPECT_EQ(see(restarts, {{"/player", "http://a:1"}}, 0, "0"), Nodes()) << "it is new";
  EXPECT_EQ(see(restarts, {{"/player", "http://a:1"}}, kSecond, "1"), Nodes());
  EXPECT_EQ(see(restarts, {}, 2 * kSecond, "2"), Nodes()) << "it has gone";
  EXPECT_EQ(see(restarts, {{"/player", "http://a:2"}}, 3 * kSecond, "3"), Nodes{"/player"});
  EXPECT_EQ(restarts.advance(60 * kSecond, {}), Nodes()) << "it is not heard";
  restarts.onHeard("/player", 61 * kSecond);
  restarts.onHeard("/player", 64 * kSecond);
  EXPECT_EQ(restarts.advance(65 * kSecond, {}), Nodes());
  EXPECT_EQ(restarts.advance(66 * kSecond, {"/player"}), Nodes()) << "it is not as usual";
  EXPECT_EQ(restarts.advance(67 * kSecond, {"/slam"}),
            Nodes{"/player restarted at 3, back as usual"});
  EXPECT_EQ(restarts.advance(68 * kSecond, {}), Nodes()) << "it was said";
}

TEST(Restarts, AreCountedForTenMinutes) {
  Restarts restarts(0);
  for (int i = 0; i <= 7; ++i) {
    see(restarts, {{"/player", "http://a:" + std::to_string(i)}}, i * kSecond, "then");
  }
  EXPECT_EQ(restarts.count("/player", 7 * kSecond), 7U);
  EXPECT_EQ(restarts.inWords("/player", 7 * kSecond), "restarted 7 times in 10 min");
  EXPECT_EQ(restarts.count("/player", 605 * kSecond), 3U);
  EXPECT_EQ(restarts.inWords("/player", 700 * kSecond), "");
  EXPECT_EQ(restarts.inWords("/slam", 0), "");
}

TEST(Restarts, AreKnownByTheNamesOfTheModel) {
  Restarts restarts(5 * kSecond);
  const ros1::Encoder fleet = encoder({{"/r[0-9]+/(.*)", "/\\1"}});
  for (const char* const address : {"http://a:1", "http://a:2"}) {
    EXPECT_EQ(restarts.see({{"/r7/play_1_1600000000000", address}}, fleet, 0, "0"), Nodes())
        << "a player is left out";
  }
  EXPECT_EQ(restarts.see({{"/r7/player", "http://a:1"}}, fleet, 0, "0"), Nodes());
  EXPECT_EQ(restarts.see({{"/r7/player", "http://a:2"}}, fleet, kSecond, "1"), Nodes{"/player"});
  EXPECT_EQ(restarts.count("/player", kSecond), 1U);
  restarts.onHeard("/player", 2 * kSecond);
  EXPECT_EQ(restarts.advance(8 * kSecond, {"/player"}), Nodes());
  EXPECT_EQ(restarts.advance(8 * kSecond, {}), Nodes{"/player restarted at 1, back as usual"});
}

TEST(Restarts, AreForgottenWhenTheClockIsSet) {
  Restarts restarts(0);
  see(restarts, {{"/player", "http://a:1"}}, 0, "then");
  see(restarts, {{"/player", "http://a:2"}}, 0, "then");
  restarts.onClockSet();
  EXPECT_EQ(restarts.count("/player", 0), 0U);
  restarts.onHeard("/player", 0);
  EXPECT_EQ(restarts.advance(kSecond, {}), Nodes());
}

}  // namespace
}  // namespace self_awareness
