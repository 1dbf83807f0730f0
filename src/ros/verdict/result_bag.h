#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/datatypes.h>
#include <rosbag/bag.h>

#include <boost/shared_ptr.hpp>
#include <cstdint>
#include <memory>
#include <string>

#include "self_awareness/SelfAwareness.h"

namespace self_awareness::ros1 {

/// A bag of what the monitor would have published of recordings, as if it had been recorded with
/// them: /self_awareness/status, /self_awareness/alarm (latching) and /diagnostics. It lies on the
/// disk as it is written; the index, some 50 bytes a message, is kept until close().
///
/// All methods that write throw BagError if that fails.
class ResultBag {
 public:
  /// Name of the node that the messages seem to come from, without the leading slash.
  static constexpr char kNode[] = "self_awareness";

  /// Creates the file, or empties the one that is there.
  explicit ResultBag(const std::string& path);
  /// Without close(), what was written is of no use.
  ~ResultBag();
  ResultBag(const ResultBag&) = delete;
  ResultBag& operator=(const ResultBag&) = delete;

  /// @param now recording time of the message [ns]; times before 1970 count as 1970
  void writeStatus(std::int64_t now, const self_awareness::SelfAwareness& status);
  void writeAlarm(std::int64_t now, const self_awareness::SelfAwareness& alarm);
  void writeDiagnostics(std::int64_t now, const diagnostic_msgs::DiagnosticArray& diagnostics);
  /// Completes the file; nothing may be written afterwards.
  void close();

  /// Whether a file is a whole bag that this class wrote, so that nothing is lost if it is written
  /// again: not a recording, although one may have the same topics.
  static bool isOne(const std::string& path);

 private:
  using Header = boost::shared_ptr<ros::M_string>;

  /// Does something with the bag.
  template <typename Work>
  void attempt(Work work);

  template <typename Message>
  void write(std::int64_t now, const Header& connection, const Message& message);

  std::string path_;
  std::unique_ptr<rosbag::Bag> bag_;  // none: it is closed, or nothing can be written
  Header status_;                     // connection headers
  Header alarm_;
  Header diagnostics_;
};

}  // namespace self_awareness::ros1
