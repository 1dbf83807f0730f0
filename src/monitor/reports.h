#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <cstdint>
#include <string>
#include <vector>

#include "diagnostics.h"
#include "part.h"
#include "ros/verdict/heard_tally.h"

namespace self_awareness {

/// Says on /diagnostics and ~components how things are: what was heard, what this and the other
/// parts know. On /diagnostics (REP-107: OK, WARN, ERROR; never STALE) there is one status for the
/// whole, one for every component, one for the monitor itself.
class Reports : public Part {
 public:
  /// @param name of the monitor, which the statuses' names begin with
  Reports(Host& host, ros::NodeHandle& node_handle, ros::NodeHandle& private_node_handle,
          const std::string& name);

  void onStart(const Session& session, const std::string& path) override;
  void onCut(Cut why) override;
  void onEvent(const core::Event& event, const core::Vocabulary& vocabulary) override;
  void onVerdict(core::Verdict& verdict, ros1::Circumstances& circumstances) override;
  void onReport(MonitorState& state) override;

  /// This program stood still. @param pause [ns of steady time]
  void onPause(std::int64_t pause);
  /// There is no model. @param error why, in words
  void onNoModel(const std::string& error) { model_error_ = error; }
  /// Publishes what all parts tell, in their order.
  void publish(const std::vector<Part*>& parts);

 private:
  /// What the clocks say now.
  static ros1::HeardTally::Moment momentNow();
  /// @param state which lists are told is decided here
  void publishDiagnostics(MonitorState& state);
  /// Why nothing has been heard for so long, in words; empty: something was.
  /// @param waited since the model began to judge [ns of steady time]
  std::string nothingHeard(const ros1::HeardReport& heard, std::int64_t waited) const;

  Host& host_;
  const std::string name_;
  ros1::StatusRound round_;
  ros1::ListRound lists_;
  ros::Publisher diagnostics_publisher_;
  ros::Publisher components_publisher_;
  ros1::HeardTally heard_;
  std::string model_error_;         // why there is no model; empty: there is one
  std::vector<std::string> mode_;   // components that are off together, as is accepted
  ros1::HeardTally::Moment now_;    // of the report
  std::int64_t started_at_ = 0;     // when the model began to judge [ns of steady time]
  std::int64_t published_at_;       // /diagnostics was last [ns of steady time]
  std::int64_t components_at_ = 0;  // ~components was published last [ns of steady time]
  std::int64_t longest_pause_ = 0;  // of this program, since the last report [ns of steady time]
};

}  // namespace self_awareness
