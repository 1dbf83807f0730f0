#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "node/live_source.h"
#include "parameters.h"
#include "ros/verdict/diagnostic_status.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/evidence/judge.h"
#include "self_awareness/core/evidence/limits/coverage.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/verdict/acceptance.h"
#include "self_awareness/core/verdict/detector.h"
#include "self_awareness/core/verdict/judge.h"
#include "self_awareness/core/verdict/source_graph.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/graph.h"
#include "self_awareness/ros/live/live_events.h"
#include "self_awareness/ros/model/model_file.h"
#include "self_awareness/ros/own_output.h"

namespace self_awareness {

/// One loaded model at work: how messages become events by it, and who judges them.
class Session {
 public:
  /// Event types that the model does not know and that are told apart; further ones share an id.
  static constexpr std::size_t kMostUnknownTypes = 1000;

  /// Starts with the model of a file.
  /// @param handler called with the verdict of every window in turn
  /// @throw ros1::ModelFileError if it cannot be read, or its calibration does not fit it
  static std::unique_ptr<Session> load(const std::string& path,
                                       const MonitorParameters& parameters,
                                       core::Detector::Handler handler);
  /// @throw std::invalid_argument if the calibration does not fit the model
  Session(ros1::TrainedModel trained, const MonitorParameters& parameters,
          core::Detector::Handler handler);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Length of a window [ns].
  std::int64_t window() const { return trained_.window; }
  /// Whether there are limits, or a threshold, for the detector that was chosen.
  bool calibrated() const { return calibrated_; }
  /// Tells the diagnostics what the model and the detector know.
  void tell(ros1::CommunicationState& state) const;
  /// Largest share of a limit that components have reached in the windows since the last call, by
  /// component; 1 is the limit. Empty: no window was judged, or not known of this detector.
  std::map<std::string, double> takeShares();
  /// A number over event types and limits, or the threshold: another one for another model. Alarms
  /// and shares depend on them, besides what is accepted.
  std::uint64_t content() const;
  /// Components that may be absent, or some topics of which may.
  const std::set<std::string>& optional() const { return optional_; }
  /// Event types of the model, by their ids.
  const std::vector<core::EventType>& types() const { return trained_.vocabulary().types(); }
  /// Event types of the model, and after them the unknown ones as they appeared.
  const core::Vocabulary& vocabulary() const { return *vocabulary_; }
  /// The rules of the encoder.
  const ros1::EncodingRules& encoding() const { return trained_.encoding; }
  const std::shared_ptr<const ros1::Encoder>& encoder() const { return encoder_; }
  core::Detector& detector() { return detector_; }
  /// Takes what is accepted as normal from now on, besides ~optional, in place of what was before.
  void accept(const core::Acceptances& accepted);
  /// What is accepted, with ~optional.
  const core::Acceptances& accepted() const { return accepted_; }
  /// Whose messages reach whom: in training, and as addEdges() was told.
  const core::SourceGraph& graph() const { return *graph_; }

  /// Whether there were more unknown types than are told apart.
  bool full() const { return vocabulary_->size() > types().size() + kMostUnknownTypes; }
  /// Event types of the model that this publisher sends.
  std::vector<core::EventId> typesOf(const ros1::Publication& publication) const;

  /// What is watched less now, in words.
  std::vector<std::string> watchedLess() const;

  /// The mode that the robot is in, up to now [ns], in words; empty: nobody tells it by the
  /// encoding, or this detector knows no modes.
  std::string mode(std::int64_t now) const;

  /// Takes note that a source was started again.
  void onRestarted(const std::string& source);
  /// Whether an event is the first of its type since its node was started again.
  bool isFirstOfRestarted(core::EventId id) { return restarted_.erase(id) > 0; }

  /// What this model has to hear.
  /// @param node full name of the monitor's process, whose own output is left out
  /// @param poll_interval between two questions to the master [s]
  LiveSource::Wanted wanted(const std::string& node, double poll_interval) const;
  /// Takes in who listens to whom now. Who was killed, or has gone since, is still upstream of its
  /// victims: edges are added only. The detector learns who does not subscribe as in training.
  /// @param node full name of the monitor's process, which is left out
  void addEdges(const ros1::Graph& graph, const std::string& node);
  /// Who sends from now on, as far as events do not say it.
  void setSenders(const core::Senders& senders);

 private:
  /// Finds out how often messages came in training.
  void expectRates();
  /// Takes in what a window says of components.
  void onShares(const core::evidence::Shares& shares);
  core::EventId intern(const core::EventType& type);
  /// An event type as people read it, without its datatype.
  std::string sourceAndTopic(core::EventId id) const;
  std::unique_ptr<core::Judge> makeJudge(const MonitorParameters& parameters);

  ros1::TrainedModel trained_;
  bool calibrated_;
  std::shared_ptr<const core::evidence::Model> model_;  // of the judge; null: it is the paper's
  // As in CommunicationState; empty: not known of this detector.
  std::vector<core::evidence::Coverage> coverage_;
  std::map<std::string, std::map<std::string, double>> expected_;
  std::vector<double> shares_;  // since they were taken, by component; empty: no window since
  core::Acceptances absences_;  // that ~optional accepts
  core::Acceptances accepted_;
  std::set<std::string> optional_;
  std::set<core::SourceGraph::Publication> unheard_;
  std::set<core::SourceGraph::Subscription> subscriptions_;  // that are expected
  std::shared_ptr<core::SourceGraph> graph_;  // of training, and what addEdges() added
  std::shared_ptr<core::Vocabulary> vocabulary_;
  std::shared_ptr<const ros1::Encoder> encoder_;
  std::set<core::EventId> restarted_;  // of the model, and not heard since their nodes were
  core::Detector detector_;
};

}  // namespace self_awareness
