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
  template <typename Data>
  class BasicLock;

 public:
  /// Holds the mutex while it lives. It cannot be copied or moved away from its block.
  using Lock = BasicLock<T>;
  using ConstLock = BasicLock<const T>;

  Lock lock() { return Lock(mutex_, data_); }
  ConstLock lock() const { return ConstLock(mutex_, data_); }

 private:
  mutable std::mutex mutex_;
  T data_;
};

template <typename T>
template <typename Data>
class Guarded<T>::BasicLock {
 public:
  BasicLock(const BasicLock&) = delete;
  BasicLock& operator=(const BasicLock&) = delete;

  Data* operator->() const { return &data_; }
  Data& operator*() const& { return data_; }
  Data& operator*() const&& = delete;  // the reference would outlive the lock

  /// Releases the mutex; the data must not be touched after it.
  void release() { lock_.unlock(); }

  /// Releases the mutex and waits until the condition holds or the time is over. The condition
  /// is looked at with the mutex held, at first and after each notification.
  /// @param condition called with the data
  template <typename Condition>
  void waitFor(std::condition_variable& changed, std::chrono::duration<double> time,
               Condition condition) {
    changed.wait_for(lock_, time, [&] { return condition(data_); });
  }

 private:
  friend class Guarded;
  BasicLock(std::mutex& mutex, Data& data) : lock_(mutex), data_(data) {}

  std::unique_lock<std::mutex> lock_;
  Data& data_;
};

}  // namespace self_awareness::ros1
