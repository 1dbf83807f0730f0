#pragma once

#include <chrono>
#include <thread>

namespace self_awareness {

/// Waits for what another thread does; false if it is not done within so many seconds.
template <typename Condition>
bool await(Condition condition, int seconds = 20) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) {
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

}  // namespace self_awareness
