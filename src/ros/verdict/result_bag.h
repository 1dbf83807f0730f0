#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>

#include <cstdint>
#include <string>

#include "self_awareness/SelfAwareness.h"
#include "self_awareness/ros/bag/bag_writer.h"

namespace self_awareness::ros1 {

/// A bag of what the monitor would have published of recordings, as if it had been recorded with
/// them: /self_awareness/status, /self_awareness/alarm (latching) and /diagnostics. Its version
/// (kVersionTopic) comes first.
///
/// All methods that write throw BagError if that fails.
class ResultBag {
 public:
  /// Name of the node that the messages seem to come from, without the leading slash.
  static constexpr char kNode[] = "self_awareness";

  /// Creates the file, or empties the one that is there. Without close() it is of no use.
  /// @param named what errors call the file; empty: by its path
  explicit ResultBag(const std::string& path, const std::string& named = "");
  ~ResultBag();
  ResultBag(const ResultBag&) = delete;
  ResultBag& operator=(const ResultBag&) = delete;

  /// @param now recording time of the message [ns]; times before 1970 count as 1970
  void writeStatus(std::int64_t now, const self_awareness::SelfAwareness& status);
  void writeAlarm(std::int64_t now, const self_awareness::SelfAwareness& alarm);
  void writeDiagnostics(std::int64_t now, const diagnostic_msgs::DiagnosticArray& diagnostics);
  /// Completes the file; nothing may be written after that.
  void close() { bag_.close(); }

  /// Whether a file is a whole bag that this class wrote, so that nothing is lost if it is written
  /// again: not a recording, although one may have the same topics.
  static bool isOne(const std::string& path);

 private:
  template <typename Message>
  void write(const std::string& topic, bool latching, std::int64_t now, const Message& message);

  BagWriter bag_;
  bool tells_version_ = false;  // what has been written says it
};

}  // namespace self_awareness::ros1
