#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "heard_tally.h"
#include "self_awareness/SelfAwareness.h"
#include "self_awareness/core/evidence/limits/coverage.h"
#include "self_awareness/core/verdict/source_graph.h"
#include "status_round.h"

namespace self_awareness::ros1 {

class AlarmState;

/// What the diagnostics tell of the robot; worded by the functions below.
struct CommunicationState {
  std::string model;        ///< path
  std::string model_error;  ///< why there is none; empty: it is loaded
  bool calibrated = false;
  std::vector<core::evidence::Coverage> coverage;  ///< of the components; empty: not known
  /// What was published in training, and nobody subscribed to, by source and topic.
  std::set<core::SourceGraph::Publication> unheard;
  /// Why nothing has been heard since the start, in words; empty: something was.
  std::string nothing_heard;
  bool started = false;                ///< something was said of a window
  self_awareness::SelfAwareness last;  ///< the verdict on the last window, if started
  double level_for = 0;                ///< how long it has had its level [s]
  HeardReport heard;
  /// Who muted what stands, and until when, in words; empty: nobody did. What is muted is OK.
  std::string muted;
  /// Who is heard that training never saw, and is not accepted.
  struct Stranger {
    std::string source;
    std::string topic;
    std::uint64_t events = 0;  ///< so far
  };
  std::vector<Stranger> strangers;
  std::vector<std::string> watched_less;  ///< now, in words
  std::vector<std::string> accepted;      ///< as normal, in words
  std::vector<std::string> mode;          ///< components that are off together now, as is accepted
  /// What is accepted of components that the model knows, in words.
  std::map<std::string, std::string> accepted_of;
  /// How often messages came in training [Hz], by component and topic; empty: not known.
  std::map<std::string, std::map<std::string, double>> expected;
  /// Components that were started again lately: how often, in words, and whether that is too
  /// often, and not muted.
  std::map<std::string, std::pair<std::string, bool>> restarts;
  std::set<std::string> optional;  ///< components that may be absent
  /// Who cannot be heard by the monitor, and why, in words; by component.
  std::map<std::string, std::string> not_heard;
  /// Largest share of a limit that components have reached since the last report, by component; 1
  /// is the limit. Empty: not known.
  std::map<std::string, double> shares;
  ListsAre lists = ListsAre::kTold;  ///< long ones

  /// Takes over what the alarm says, and what was heard.
  /// @param now ROS time [ns]
  void take(const AlarmState& alarm, const HeardReport& report, std::int64_t now);
};

/// The hardware id where none is set: diagnostics want one.
constexpr char kNoHardware[] = "none";

/// What one node publishes on /diagnostics at a time. diagnostic_updater::Updater does more: it
/// asks the master for its period when it publishes, and throws when that, or ROS time, is at its
/// end. The names of the statuses begin with the node's own name, and end with its namespace: so
/// one beginning fits the monitors of all robots (config/diagnostic_analyzers.yaml).
class DiagnosticStatuses {
 public:
  /// @param node its full name
  /// @param now ROS time [ns]
  DiagnosticStatuses(const std::string& node, const std::string& hardware_id, std::int64_t now);

  /// @param status its name and hardware id are filled in
  void add(const std::string& name, const diagnostic_updater::DiagnosticStatusWrapper& status);

  /// Adds a status of another one of the same node.
  void add(const diagnostic_msgs::DiagnosticStatus& status) { message_.status.push_back(status); }

  const diagnostic_msgs::DiagnosticArray& message() const { return message_; }

 private:
  std::string prefix_;
  std::string suffix_;  // empty: it is in no namespace
  std::string hardware_id_;
  diagnostic_msgs::DiagnosticArray message_;
};

/// A number as the diagnostics show it; "none" for NaN.
std::string number(double value);
/// The lists in the status of the whole, by their keys.
std::vector<std::pair<std::string, std::vector<std::string>>> listsOf(
    const CommunicationState& state);
/// Fills in the level, message and values of the status of the whole.
void tellCommunication(const CommunicationState& state,
                       diagnostic_updater::DiagnosticStatusWrapper& status);
/// Why the death of a component is not found; empty: it is.
std::string whyNotWatched(const core::evidence::Coverage& component);
/// Fills in the level, message and values of the status of one component.
/// @param name one of state.heard.components
/// @param coverage how soon its faults are found; null: not known
void tellComponent(const CommunicationState& state, const std::string& name,
                   const core::evidence::Coverage* coverage,
                   diagnostic_updater::DiagnosticStatusWrapper& status);
/// Adds the status of every component.
void addComponents(const CommunicationState& state, DiagnosticStatuses& statuses);
/// Keeps of the statuses of components those that `round` chooses; what was added before is kept.
/// @param of_components statuses of components, as addComponents() adds them
/// @param elapsed since the last message [s]
void addChosen(const DiagnosticStatuses& of_components, StatusRound& round, double elapsed,
               DiagnosticStatuses& statuses);
/// The statuses of the whole and of every component, as a node publishes them on /diagnostics.
/// @param node its full name
/// @param now ROS time [ns]
diagnostic_msgs::DiagnosticArray toDiagnostics(const CommunicationState& state,
                                               const std::string& node, std::int64_t now);

}  // namespace self_awareness::ros1
