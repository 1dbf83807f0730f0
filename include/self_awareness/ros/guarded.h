#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace self_awareness::ros1 {

/// Data that several threads share, together with the mutex that guards it. The data can only be
/// reached through the lock: code that forgets the lock does not compile.
///
///     Guarded<Counts> counts;
///     ++counts.lock()->dropped;        // locked for this statement
///     const auto held = counts.lock(); // locked for this block
template <typename T>
class Guarded {
 public:
  /// Holds the mutex while it lives. It cannot be copied or moved away from its block.
  template <typename Data>
  class Lock {
   public:
    Lock(std::mutex& mutex, Data& data) : lock_(mutex), data_(data) {}
    Lock(const Lock&) = delete;
    Lock& operator=(const Lock&) = delete;

    Data* operator->() const { return &data_; }
    Data& operator*() const& { return data_; }
    Data& operator*() const&& = delete;  // the reference would outlive the lock

    /// Releases the mutex and waits until the condition holds or the time is over. The condition
    /// is looked at with the mutex held, at first and after each notification.
    /// @param condition called with the data
    template <typename Condition>
    void waitFor(std::condition_variable& changed, std::chrono::duration<double> time,
                 Condition condition) {
      changed.wait_for(lock_, time, [&] { return condition(data_); });
    }

   private:
    std::unique_lock<std::mutex> lock_;
    Data& data_;
  };

  Lock<T> lock() { return {mutex_, data_}; }
  Lock<const T> lock() const { return {mutex_, data_}; }

 private:
  mutable std::mutex mutex_;
  T data_;
};

}  // namespace self_awareness::ros1
