#pragma once

#include <chrono>
#include <thread>

namespace self_awareness {

/// Waits for what another thread does; false if it is not done within 20 s.
template <typename Condition>
bool await(Condition condition) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) {
      return false;
    }
    std::this_thread::yield();
  }
  return true;
}

}  // namespace self_awareness
