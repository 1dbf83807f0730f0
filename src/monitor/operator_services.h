#pragma once

#include <std_srvs/Trigger.h>

#include <functional>
#include <string>
#include <vector>

#include "operator_calls.h"
#include "part.h"

namespace self_awareness {

/// The services that take back an alarm: ~reset, ~clear and ~reload.
class OperatorServices : public Part {
 public:
  /// @param calls admits them
  /// @param reload reads the model again: returns why it failed; empty: it did not
  OperatorServices(OperatorCalls& calls, Host& host, std::function<std::string()> reload);

  std::vector<ros::ServiceServer> advertise(ros::NodeHandle& private_node_handle) override;
  void onReport(MonitorState& state) override;

 private:
  using Call = ros::ServiceEvent<std_srvs::Trigger::Request, std_srvs::Trigger::Response>;

  bool onReset(Call& call);
  bool onClear(Call& call);
  bool onReload(Call& call);
  /// Says that what stood is over; keeps on record who has called.
  void standDown(const Call& call, const std::string& service, const std::string& message);

  OperatorCalls& calls_;
  Host& host_;
  const std::function<std::string()> reload_;
};

}  // namespace self_awareness
