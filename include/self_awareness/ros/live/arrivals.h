#pragma once

#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace self_awareness::ros1 {

/// One message, as it was received.
struct Arrival {
  /// A topic, as long as it is subscribed to and messages of it are waiting.
  struct Topic {
    std::string name;
    /// Whether messages are read. Until the first ones have told the type, nobody knows what needs
    /// none of their content.
    std::atomic<bool> reads{true};
    std::uint32_t waiting = 0;  ///< guarded by the mutex of Arrivals
  };
  using Content = std::vector<std::uint8_t>;

  std::shared_ptr<Topic> topic;
  boost::shared_ptr<ros::M_string> header;   ///< all messages of a connection share one
  std::int64_t stamp = 0;                    ///< of its receipt [ns]
  boost::shared_ptr<const Content> content;  ///< serialized; none: it was not read
};

/// Subscribes to topics of any type and keeps what arrives for the one thread that takes it, many
/// messages at a time.
///
/// Made for a cost below that of any subscriber with a message type: roscpp's receiving thread
/// writes down time and connection itself, so that a message does not wake a second thread, and
/// nothing of it is copied, unless somebody reads that topic. ShapeShifter would copy the payload
/// and the type's definition with every message (docs/performance.md).
class Arrivals {
 public:
  /// @param queue_size messages a topic may have waiting; what comes then is dropped
  /// @param wake called by any thread when what waits should be taken soon; must not block
  Arrivals(std::uint32_t queue_size, std::function<void()> wake);
  ~Arrivals();
  Arrivals(const Arrivals&) = delete;
  Arrivals& operator=(const Arrivals&) = delete;

  /// Must outlive the subscriber.
  ros::Subscriber subscribe(ros::NodeHandle& node_handle, const std::string& topic);

  /// Wakes with the first arrival in each interval [ns] of the absolute grid.
  void setInterval(std::int64_t interval);
  /// Puts what waits into `arrivals`, in the order of its arrival, in place of what is there.
  void take(std::vector<Arrival>& arrivals);
  /// Number of messages that were dropped since the start.
  std::uint64_t dropped() const;

 private:
  class Helper;
  class ImmediateQueue;

  void add(Arrival arrival);

  const std::uint32_t queue_size_;
  const std::function<void()> wake_;
  const std::unique_ptr<ros::CallbackQueueInterface> immediate_queue_;

  mutable std::mutex mutex_;
  std::vector<Arrival> waiting_;    // guarded by mutex_
  std::uint64_t dropped_ = 0;       // guarded by mutex_
  std::int64_t interval_;           // guarded by mutex_
  std::int64_t this_interval_ = 0;  // start of the last arrival's; guarded by mutex_
};

}  // namespace self_awareness::ros1
