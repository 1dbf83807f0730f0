#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "file_writer.h"
#include "operator_calls.h"
#include "ros/verdict/diagnostic_status.h"
#include "self_awareness/Accept.h"
#include "self_awareness/Incidents.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/verdict/acceptance.h"
#include "self_awareness/core/verdict/alarm.h"

namespace self_awareness {

/// The service ~accept: what an operator takes as normal from now on. It is kept in a file beside
/// the model, for other starts, and for `train` and `calibrate` (docs/accept.md).
///
/// Belongs to the thread that judges; a thread of its own waits for the disk.
class AcceptCalls {
 public:
  /// What a call may refer to.
  struct Standing {
    std::optional<core::Alarm> alarm;  ///< none: nothing stands
    const self_awareness::Incidents& incidents;
    const core::Vocabulary& vocabulary;  ///< that the ids of the alarm's suspects are of
    std::int64_t now;                    ///< ROS time [ns]
  };
  struct Handlers {
    /// What is there now; none: no model judges by evidence.
    std::function<std::optional<Standing>()> standing;
    /// Called when something more is accepted, or less. @param caller name of the node
    std::function<void(const std::string& caller)> on_change;
  };

  /// @param calls admits them
  AcceptCalls(OperatorCalls& calls, Handlers handlers);
  AcceptCalls(const AcceptCalls&) = delete;
  AcceptCalls& operator=(const AcceptCalls&) = delete;

  /// Offers the service, for as long as the server lives. It is called in the thread that serves
  /// the node handle.
  ros::ServiceServer advertise(ros::NodeHandle& private_node_handle);
  /// Reads what is accepted beside a model. A file that is damaged is named in the log, and is
  /// written anew with the next call.
  void read(const std::string& model);
  /// Writes what is not written yet, and waits for the disk.
  void finish() { writer_.finish(); }

  const core::Acceptances& accepted() const { return accepted_; }
  /// Whether what stands is accepted: that of its culprit is.
  /// @param vocabulary that the ids of its suspects are of
  bool covers(const core::Alarm& alarm, const core::Vocabulary& vocabulary) const;
  /// Tells the diagnostics what is accepted. @param types of the model
  void tell(const std::vector<core::EventType>& types, ros1::CommunicationState& state) const;
  /// Why the file could not be written; empty: it could.
  std::string error() const { return writer_.report().error; }

 private:
  using Call = ros::ServiceEvent<Accept::Request, Accept::Response>;

  bool onAccept(Call& call);
  /// @return what is accepted now, in words
  /// @throw std::invalid_argument says what is wrong with the request
  std::string serve(const Accept::Request& request, const std::string& caller);
  void write();

  OperatorCalls& calls_;
  const Handlers handlers_;
  std::string path_;
  core::Acceptances accepted_;
  FileWriter writer_;
};

}  // namespace self_awareness
