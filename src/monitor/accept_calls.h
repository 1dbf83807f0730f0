#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "accept_request.h"
#include "node/file_writer.h"
#include "operator_calls.h"
#include "part.h"
#include "ros/verdict/diagnostic_status.h"
#include "self_awareness/Accept.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/verdict/acceptance.h"
#include "self_awareness/core/verdict/alarm.h"

namespace self_awareness {

/// The service ~accept: what an operator takes as normal from now on. It is kept in a file beside
/// the model, for other starts, and for `train` and `calibrate` (docs/live.md).
///
/// Belongs to the thread that judges; a thread of its own waits for the disk.
class AcceptCalls : public Part {
 public:
  struct Handlers {
    /// What is there now; none: no model judges by evidence.
    std::function<std::optional<Acceptable>()> acceptable;
    /// Called when something more is accepted, or something was taken back.
    /// @param caller name of the node
    std::function<void(const std::string& caller)> on_change;
  };

  /// @param calls admits them
  AcceptCalls(OperatorCalls& calls, Handlers handlers);

  std::vector<ros::ServiceServer> advertise(ros::NodeHandle& private_node_handle) override;
  void onStart(const Session& session, const std::string& path) override;
  void onReport(MonitorState& state) override;
  /// Reads what is accepted beside a model; what is not written yet is newer. A file that is
  /// damaged is named in the log, and is written anew with the next call.
  void read(const std::string& model);
  /// Does what a call asks for. @return the answer
  Accept::Response serve(const Accept::Request& request, const std::string& caller);
  /// Writes what is not written yet, and waits for the disk.
  void finish() override { writer_.finish(); }

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

  /// What was to be written last.
  struct Written {
    std::string path;
    core::Acceptances accepted;
    std::shared_ptr<std::atomic<bool>> done;  // null: nothing was
  };

  bool onAccept(Call& call);
  /// Accepts what is asked for, as long as there is room.
  /// @return what is accepted now; what is not is added to the refused
  std::vector<core::Acceptance> accept(const Acceptable& acceptable, const std::string& caller,
                                       WantedAcceptances& request);
  /// Takes back what fits. @return as accept()
  std::vector<core::Acceptance> takeBack(WantedAcceptances& request);
  /// Of what is accepted, in the answer: nobody of that name may be known yet.
  static std::string unknownOf(const std::vector<core::Acceptance>& all,
                               const core::Vocabulary& vocabulary);
  void write();

  OperatorCalls& calls_;
  const Handlers handlers_;
  const Session* session_ = nullptr;  // that judges; null: none does yet
  std::string path_;
  core::Acceptances accepted_;
  Written written_;
  FileWriter writer_;
};

}  // namespace self_awareness
