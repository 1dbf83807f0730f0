#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "operator_calls.h"
#include "self_awareness/Maintenance.h"
#include "self_awareness/Mute.h"
#include "self_awareness/SelfAwareness.h"
#include "self_awareness/core/verdict/alarm.h"
#include "self_awareness/core/verdict/mute.h"
#include "session.h"

namespace self_awareness {

/// The services ~mute and ~maintenance: what an operator does not want to be told for a while.
///
/// Times are steady [ns]. Belongs to the thread that judges.
class MuteCalls {
 public:
  /// Longest mute [s].
  static constexpr double kLongest = 86400;

  /// @param calls admits them
  /// @param on_change called when there is a mute more or less; it has to call onStanding()
  MuteCalls(OperatorCalls& calls, std::function<void()> on_change);
  MuteCalls(const MuteCalls&) = delete;
  MuteCalls& operator=(const MuteCalls&) = delete;

  /// Offers the services, for as long as the servers live. They are called in the thread that
  /// serves the node handle.
  std::vector<ros::ServiceServer> advertise(ros::NodeHandle& private_node_handle);

  /// Ends those whose time has come, and says in the log what they have muted.
  void advance(std::int64_t now);
  /// Takes in what stands now, whenever that has changed, or the mutes have.
  /// @return whether something stands that was muted, and is not any more
  bool onStanding(const std::optional<core::Alarm>& standing, const Session& session);
  /// Says in the log what stands; where it is muted, as no more than INFO.
  void log(const self_awareness::SelfAwareness& alarm) const;

  /// Why what stands is not told: "/player until 15:04:11 UTC, by /rqt"; empty: it is told, or
  /// nothing stands.
  std::string ofWhatStands() const;
  /// Whether everything is muted: maintenance.
  bool mutesAll() const;
  /// Why nothing is told of a component, likewise; empty: it is.
  std::string ofComponent(const std::string& component) const;
  /// All mutes in words, with what they have muted so far.
  std::vector<std::string> inWords() const;

 private:
  using Call = ros::ServiceEvent<Mute::Request, Mute::Response>;
  using MaintenanceCall = ros::ServiceEvent<Maintenance::Request, Maintenance::Response>;

  bool onMute(Call& call);
  bool onMaintenance(MaintenanceCall& call);
  template <typename Response>
  void answer(const core::Mute& mute, double duration, Response& response);

  OperatorCalls& calls_;
  const std::function<void()> on_change_;
  core::Mutes mutes_;
  bool muted_ = false;  // what stood last
};

}  // namespace self_awareness
