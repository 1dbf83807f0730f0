#include "self_awareness/ros/guarded.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace self_awareness::ros1 {
namespace {

struct Counts {
  int events = 0;
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

}  // namespace
}  // namespace self_awareness::ros1
