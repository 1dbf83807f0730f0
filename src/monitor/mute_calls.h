#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>

#include <optional>
#include <string>
#include <vector>

#include "operator_calls.h"
#include "part.h"
#include "self_awareness/Maintenance.h"
#include "self_awareness/Mute.h"
#include "self_awareness/SelfAwareness.h"
#include "self_awareness/core/verdict/alarm.h"
#include "self_awareness/core/verdict/mute.h"

namespace self_awareness {

/// The service ~mute: what an operator does not want to be told for a while. ~maintenance mutes
/// all.
///
/// Times are steady [ns]. Belongs to the thread that judges.
class MuteCalls : public Part {
 public:
  /// Longest mute [s].
  static constexpr double kLongest = 86400;

  /// @param calls admits them
  /// @param host whose alarms are muted
  MuteCalls(OperatorCalls& calls, Host& host) : calls_(calls), host_(host) {}

  std::vector<ros::ServiceServer> advertise(ros::NodeHandle& private_node_handle) override;
  /// Says in the log what stands; where it is muted, as no more than INFO.
  void onAlarm(const ros1::AlarmState& alarm) override;
  /// Ends mutes whose time has come, and says in the log what they have muted.
  void onTick(const Moment& now) override;
  /// Takes out what is muted of what the parts before have told.
  void onReport(MonitorState& state) override;

  /// Why nothing is told of a component, likewise; empty: it is.
  std::string ofComponent(const std::string& component) const;

 private:
  using Call = ros::ServiceEvent<Mute::Request, Mute::Response>;
  using MaintenanceCall = ros::ServiceEvent<Maintenance::Request, Maintenance::Response>;

  /// Takes in what stands now, whenever that has changed, or the mutes have.
  /// @return whether something stands that was muted, and is not any more
  bool onStanding(const std::optional<core::Alarm>& standing);
  /// There is a mute more or less.
  void onChange();
  void log(const self_awareness::SelfAwareness& alarm) const;
  /// Why what stands is not told: "/player until 15:04:11 UTC, by /rqt"; empty: it is told, or
  /// nothing stands.
  std::string ofWhatStands() const;
  /// Whether everything is muted: maintenance.
  bool mutesAll() const;
  bool onMute(Call& call);
  bool onMaintenance(MaintenanceCall& call);
  /// Does what a call asks for. @return the answer
  Mute::Response serve(const Mute::Request& request, const std::string& caller);

  OperatorCalls& calls_;
  Host& host_;
  core::Mutes mutes_;
  bool muted_ = false;  // what stood last
};

}  // namespace self_awareness
