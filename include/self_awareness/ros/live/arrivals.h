#pragma once

#include <ros/datatypes.h>
#include <topic_tools/shape_shifter.h>

#include <boost/shared_ptr.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "self_awareness/core/stream/windows.h"
#include "self_awareness/ros/guarded.h"

namespace self_awareness::ros1 {

/// One message, as roscpp received it.
struct Arrival {
  std::shared_ptr<const std::string> topic;
  boost::shared_ptr<ros::M_string> header;      ///< all messages of a connection share one
  std::int64_t stamp = 0;                       ///< ROS time of its receipt [ns]
  std::int64_t steady = 0;                      ///< the same by the steady clock [ns]
  topic_tools::ShapeShifter::ConstPtr message;  ///< null: nobody wants its content
  std::uint32_t size = 0;                       ///< of the message [bytes]
};

/// Keeps what arrives, in any thread, for the one thread that takes it, many messages at a time.
///
/// Each connection has a queue of its own: a publisher that floods a topic makes no other one lose
/// messages.
class Arrivals {
 public:
  /// Most bytes of messages that may wait, of all connections together.
  static constexpr std::size_t kMostBytes = 200000000;
  /// Larger messages [bytes] are copied by a thread of their own, and read seldom.
  static constexpr std::uint32_t kLarge = 65536;

  /// A connection of which messages were dropped.
  struct Dropped {
    std::shared_ptr<const std::string> topic;
    boost::shared_ptr<ros::M_string> header;
  };

  /// @param queue_size messages a connection may have waiting; what comes then is dropped
  /// @param wake called by any thread when what waits should be taken soon; must not block
  Arrivals(std::uint32_t queue_size, std::function<void()> wake);

  void add(Arrival arrival);
  /// Messages of this connection are taken without their content until then [ns of steady time]:
  /// several images that wait at once cost more time and memory than one after the other.
  void dropContent(const ros::M_string* header, std::int64_t until);

  /// Wakes with the first arrival in each interval [ns] of the absolute grid.
  void setInterval(std::int64_t interval);
  /// Puts what waits into `arrivals`, in the order of its arrival, in place of what is there.
  /// @return connections of which messages were dropped since the last call
  std::vector<Dropped> take(std::vector<Arrival>& arrivals);
  /// Number of messages that came since the start, with those that were dropped.
  std::uint64_t arrived() const { return waiting_.lock()->arrived; }
  /// Number of messages that were dropped since the start.
  std::uint64_t dropped() const { return waiting_.lock()->dropped; }

 private:
  struct Waiting {
    std::vector<Arrival> arrivals;
    // How many arrivals, by the connection's header, which the arrivals keep alive.
    std::unordered_map<const ros::M_string*, std::uint32_t> of_connection;
    std::size_t bytes = 0;
    std::unordered_map<const ros::M_string*, std::int64_t> no_content_until;
    std::vector<Dropped> dropped_of;
    std::uint64_t arrived = 0;
    std::uint64_t dropped = 0;
    std::int64_t interval = core::kDefaultWindow;
    std::int64_t last_interval = 0;  // start of the last arrival's
  };

  static void drop(Waiting& waiting, const Arrival& arrival);

  const std::uint32_t queue_size_;
  const std::function<void()> wake_;
  Guarded<Waiting> waiting_;
};

}  // namespace self_awareness::ros1
