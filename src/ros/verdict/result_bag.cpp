#include "result_bag.h"

#include <ros/message_traits.h>
#include <rosbag/view.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <stdexcept>
#include <vector>

#include "self_awareness/ros/bag/bag_reader.h"
#include "self_awareness/ros/ros_time.h"
#include "verdict_message.h"

namespace self_awareness::ros1 {
namespace {

// Only what a program names as its own work may be replaced by it. A field of the connection
// headers survives all that rosbag does with a bag, and disturbs nobody.
constexpr char kWriterField[] = "written_by";
constexpr char kWriter[] = "self_awareness score";

template <typename Message>
boost::shared_ptr<ros::M_string> connectionHeader(const std::string& topic, bool latching) {
  namespace traits = ros::message_traits;
  return boost::make_shared<ros::M_string>(
      ros::M_string{{"topic", topic},
                    {"type", traits::datatype<Message>()},
                    {"md5sum", traits::md5sum<Message>()},
                    {"message_definition", traits::definition<Message>()},
                    {"callerid", std::string("/") + ResultBag::kNode},
                    {"latching", latching ? "1" : "0"},
                    {kWriterField, kWriter}});
}

std::string privateTopic(const std::string& name) {
  return std::string("/") + ResultBag::kNode + "/" + name;
}

}  // namespace

ResultBag::ResultBag(const std::string& path)
    : path_(path),
      bag_(std::make_unique<rosbag::Bag>()),
      status_(connectionHeader<self_awareness::SelfAwareness>(privateTopic("status"), false)),
      alarm_(connectionHeader<self_awareness::SelfAwareness>(privateTopic("alarm"), true)),
      diagnostics_(connectionHeader<diagnostic_msgs::DiagnosticArray>("/diagnostics", false)) {
  attempt([&] {
    bag_->open(path_, rosbag::bagmode::Write);
    bag_->setCompression(rosbag::compression::LZ4);
  });
}

ResultBag::~ResultBag() {
  try {
    if (bag_) {
      bag_->close();
    }
  } catch (const rosbag::BagException&) {  // nobody waits for this file any more
    static_cast<void>(bag_.release());     // as in attempt()
  }
}

template <typename Work>
void ResultBag::attempt(Work work) {
  if (!bag_) {
    throw std::logic_error(path_ + ": is closed, or could not be written before");
  }
  try {
    work();
  } catch (const rosbag::BagException& error) {
    // Its destructor would write once more, and that error ends the program: better a leak.
    static_cast<void>(bag_.release());
    throw BagError(path_ + ": cannot be written (" + error.what() + ")");
  }
}

void ResultBag::writeStatus(std::int64_t now, const self_awareness::SelfAwareness& status) {
  write(now, status_, status);
}

void ResultBag::writeAlarm(std::int64_t now, const self_awareness::SelfAwareness& alarm) {
  write(now, alarm_, alarm);
}

void ResultBag::writeDiagnostics(std::int64_t now,
                                 const diagnostic_msgs::DiagnosticArray& diagnostics) {
  write(now, diagnostics_, diagnostics);
}

template <typename Message>
void ResultBag::write(std::int64_t now, const Header& connection, const Message& message) {
  attempt([&] {
    bag_->write(connection->at("topic"), std::max(toRosTime(now), ros::TIME_MIN), message,
                connection);
  });
}

void ResultBag::close() {
  attempt([&] { bag_->close(); });
  bag_.reset();
  // rosbag does not look whether the last bytes reached the disk.
  if (!isOne(path_)) {
    throw BagError(path_ + ": cannot be written (is the disk full?)");
  }
}

bool ResultBag::isOne(const std::string& path) {
  try {
    const rosbag::Bag bag(path, rosbag::bagmode::Read);
    rosbag::View view(bag);
    const std::vector<const rosbag::ConnectionInfo*> connections = view.getConnections();
    return !connections.empty() &&
           std::all_of(connections.begin(), connections.end(), [](const auto* connection) {
             const auto writer = connection->header->find(kWriterField);
             return writer != connection->header->end() && writer->second == kWriter;
           });
  } catch (const rosbag::BagException&) {  // no bag, or not a whole one
    return false;
  }
}

}  // namespace self_awareness::ros1
