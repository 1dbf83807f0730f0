#include "self_awareness/ros/guarded.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace self_awareness::ros1 {
namespace {

struct Counts {
  int events = 0;
  bool over = false;
};

TEST(Guarded, ThreadsWaitForEachOther) {
  constexpr int kThreads = 4;
  constexpr int kEvents = 100000;
  Guarded<Counts> counts;
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i) {
    threads.emplace_back([&] {
      for (int event = 0; event < kEvents; ++event) {
        ++counts.lock()->events;
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(counts.lock()->events, kThreads * kEvents);
}

TEST(Guarded, GivesTheMutexFreeWhileItWaits) {
  Guarded<Counts> counts;
  std::condition_variable changed;
  std::thread other([&] {
    counts.lock()->over = true;
    changed.notify_all();
  });
  {
    auto held = counts.lock();
    held.waitFor(changed, std::chrono::minutes(1), [](const Counts& now) { return now.over; });
    EXPECT_TRUE(held->over);
  }
  other.join();
}

TEST(Guarded, WaitsNoLongerThanItShould) {
  Guarded<Counts> counts;
  std::condition_variable changed;
  auto held = counts.lock();
  held.waitFor(changed, std::chrono::milliseconds(1), [](const Counts& now) { return now.over; });
  EXPECT_FALSE(held->over);
}

}  // namespace
}  // namespace self_awareness::ros1
