#pragma once

#include <ros/datatypes.h>

#include <atomic>
#include <boost/shared_ptr.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "self_awareness/core/stream/windows.h"
#include "self_awareness/ros/live/guarded.h"

namespace topic_tools {
class ShapeShifter;
}

namespace self_awareness::ros1 {

/// One message, as it was received.
struct Arrival {
  /// A topic, while it is subscribed to or messages of it are waiting.
  struct Topic {
    Topic(std::string topic, std::size_t topic_number)
        : name(std::move(topic)), number(topic_number) {}

    const std::string name;
    const std::size_t number;  ///< counted by Arrivals; a topic that comes again has the same
    /// Whether the content of its messages is wanted. At first it is: which messages need not be
    /// read is not known before the first of them have told the type.
    std::atomic<bool> content_wanted{true};
  };

  std::shared_ptr<Topic> topic;
  boost::shared_ptr<ros::M_string> header;  ///< all messages of a connection share one
  std::int64_t stamp = 0;                   ///< of its receipt [ns]
  boost::shared_ptr<const topic_tools::ShapeShifter> content;  ///< none: it was not read
};

/// Keeps what arrives, in any thread, for the one thread that takes it, many messages at a time.
class Arrivals {
 public:
  /// @param queue_size messages a topic may have waiting; what comes then is dropped
  /// @param wake called by any thread when what waits should be taken soon; must not block
  Arrivals(std::uint32_t queue_size, std::function<void()> wake);

  /// A topic whose messages will arrive.
  std::shared_ptr<Arrival::Topic> addTopic(const std::string& name);
  void add(Arrival arrival);

  /// Wakes with the first arrival in each interval [ns] of the absolute grid.
  void setInterval(std::int64_t interval);
  /// Puts what waits into `arrivals`, in the order of its arrival, in place of what is there.
  void take(std::vector<Arrival>& arrivals);
  /// Number of messages that were dropped since the start.
  std::uint64_t dropped() const { return waiting_.lock()->dropped; }

 private:
  struct Waiting {
    std::vector<Arrival> arrivals;
    std::map<std::string, std::size_t> topics;  // numbers by name
    std::vector<std::uint32_t> of_topic;        // how many arrivals, by the topic's number
    std::uint64_t dropped = 0;
    std::int64_t interval = core::kDefaultWindow;
    std::int64_t last_interval = 0;  // start of the last arrival's
  };

  const std::uint32_t queue_size_;
  const std::function<void()> wake_;
  Guarded<Waiting> waiting_;
};

}  // namespace self_awareness::ros1
