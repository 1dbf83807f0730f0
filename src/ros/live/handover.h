#pragma once

#include <atomic>

namespace self_awareness::ros1 {

/// Which of several subscriptions to one topic counts a message, so that each message counts once
/// while a new subscription takes over. Subscriptions are numbered from 0; the first one counts
/// until another one is ready.
class Handover {
 public:
  /// Whether a message counts for this subscription. To be asked by each subscription that gets
  /// the message, the oldest first, and for one message after the other.
  bool counts(int number) {
    if (number == counting_) {
      counting_ = newest_.load();
    }
    return number == counting_;
  }

  /// Number of the newest subscription that is ready.
  int newest() const { return newest_; }
  /// The next subscription is sure to get each message from now on. It counts from the first
  /// message on that an older one gets, too: what a latching connection sends again to the new one
  /// alone does not count. May be called by another thread than counts().
  void ready() { ++newest_; }
  /// Whether the newest subscription counts: the others are not needed any more.
  bool complete() const { return counting_ == newest_; }

 private:
  std::atomic<int> counting_{0};
  std::atomic<int> newest_{0};
};

}  // namespace self_awareness::ros1
