#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "accept_calls.h"
#include "host.h"
#include "operator_calls.h"
#include "part.h"
#include "self_awareness/Incidents.h"

namespace self_awareness {

/// Has the model at work judge by what operators accept (AcceptCalls).
class AcceptService : public Part {
 public:
  /// @param calls admits calls
  /// @param incidents that a call may refer to
  AcceptService(OperatorCalls& calls, Host& host,
                std::function<const self_awareness::Incidents&()> incidents);

  std::vector<ros::ServiceServer> advertise(ros::NodeHandle& private_node_handle) override;
  void onStart(const Session& session, const std::string& path) override;
  void onReport(MonitorState& state) override;
  void finish() override { accepts_.finish(); }

 private:
  /// What ~accept may refer to; none: there is no model, or it is the paper's detector that
  /// judges.
  std::optional<Acceptable> acceptable();
  void onAccepted(const std::string& caller);

  OperatorCalls& calls_;
  Host& host_;
  const std::function<const self_awareness::Incidents&()> incidents_;
  AcceptCalls accepts_;
};

}  // namespace self_awareness
