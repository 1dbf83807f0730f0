#include "monitor/restarts.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace self_awareness {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
using Names = std::vector<std::string>;

TEST(Restarts, AnotherAddressIsARestartAndTheLineComesWhenAllIsAsUsual) {
  Restarts restarts(5 * kSecond);
  EXPECT_EQ(restarts.see({{"/player", "http://a:1"}}, 0, "0"), Names()) << "it is new";
  EXPECT_EQ(restarts.see({{"/player", "http://a:1"}}, kSecond, "1"), Names());
  EXPECT_EQ(restarts.see({}, 2 * kSecond, "2"), Names()) << "it has gone";
  EXPECT_EQ(restarts.see({{"/player", "http://a:2"}}, 3 * kSecond, "3"), Names{"/player"});
  EXPECT_EQ(restarts.advance(60 * kSecond, {}), Names()) << "it is not heard";
  restarts.onHeard("/player", 61 * kSecond);
  restarts.onHeard("/player", 64 * kSecond);
  EXPECT_EQ(restarts.advance(65 * kSecond, {}), Names());
  EXPECT_EQ(restarts.advance(66 * kSecond, {"/player"}), Names()) << "it is not as usual";
  EXPECT_EQ(restarts.advance(67 * kSecond, {"/slam"}),
            Names{"/player restarted at 3, back as usual"});
  EXPECT_EQ(restarts.advance(68 * kSecond, {}), Names()) << "it was said";
}

TEST(Restarts, AreCountedForTenMinutes) {
  Restarts restarts(0);
  for (int i = 0; i <= 7; ++i) {
    restarts.see({{"/player", "http://a:" + std::to_string(i)}}, i * kSecond, "then");
  }
  EXPECT_EQ(restarts.count("/player", 7 * kSecond), 7U);
  EXPECT_EQ(restarts.inWords("/player", 7 * kSecond), "restarted 7 times in 10 min");
  EXPECT_EQ(restarts.count("/player", 605 * kSecond), 3U);
  EXPECT_EQ(restarts.inWords("/player", 700 * kSecond), "");
  EXPECT_EQ(restarts.inWords("/slam", 0), "");
}

TEST(Restarts, AreForgottenWhenTheClockIsSet) {
  Restarts restarts(0);
  restarts.see({{"/player", "http://a:1"}}, 0, "then");
  restarts.see({{"/player", "http://a:2"}}, 0, "then");
  restarts.onClockSet();
  EXPECT_EQ(restarts.count("/player", 0), 0U);
  restarts.onHeard("/player", 0);
  EXPECT_EQ(restarts.advance(kSecond, {}), Names());
}

}  // namespace
}  // namespace self_awareness
