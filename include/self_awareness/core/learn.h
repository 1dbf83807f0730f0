#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "self_awareness/core/evidence/limits/cross_fit.h"
#include "self_awareness/core/evidence/limits/limits.h"
#include "self_awareness/core/model.h"
#include "self_awareness/core/paper/binning.h"
#include "self_awareness/core/stream/clock_steps.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/stream/waiting.h"
#include "self_awareness/core/stream/windows.h"

namespace self_awareness::core {

/// A recording of normal operation.
struct Recording {
  std::vector<Event> events;  ///< in their order
  std::string name;           ///< as the model calls it; may be empty
  /// Any number of its own, such as a hash: it says which half of the training the recording
  /// belongs to, and whether it is the same as another. None: its place among the others.
  std::optional<std::uint64_t> fingerprint{};
  std::int64_t robot_start = 0;  ///< when the robot was started [ns]; 0: not known
  std::string robot{};           ///< its name; empty: not known
  /// With which the clock was set forward, which the stamps do not say by themselves.
  ClockSteps clock_steps{};
  /// How the machine was, one stretch of time after the other; empty: not known.
  std::vector<Waiting> waiting{};
  /// When it began [ns], if that was before its events; none: with the first one.
  std::optional<std::int64_t> since{};
  /// What it holds from then on before its events, and is not learned from: it only says when
  /// their types come first.
  std::vector<Event> before{};
};

/// Where the second part of a recording begins [ns]: each part is learned from by itself as long
/// as all recordings belong to one half.
/// @param first, last stamps of its events [ns]
inline std::int64_t middleOf(std::int64_t first, std::int64_t last) {
  return first + (last - first) / 2;
}
/// The same by its events; 0 without any.
std::int64_t middleOf(const std::vector<Event>& events);

/// Finds the limits of a model by recordings of normal operation (docs/method.md, section 5):
/// those that it was trained on, each judged by what the others say, and those that it was not.
class Calibrator {
 public:
  /// How limits are found.
  struct Parameters {
    /// Left out at a recording's start [ns].
    std::int64_t settle_time = evidence::LimitFinder::Parameters{}.settle_time;
  };

  /// @param model only what it watches is needed, and its recordings
  /// @throw std::invalid_argument as Model::requireWatched(), or if a parameter is out of range
  Calibrator(const Model& model, const Parameters& parameters);
  /// A calibrator without findings, for the same model: another thread may use it.
  std::unique_ptr<Calibrator> part() const;

  /// Takes in a recording that the model was trained on; ids are the model's.
  /// @throw std::invalid_argument if it has no fingerprint
  void addTrainedOn(const Recording& recording);
  /// Takes in a recording that the model was not trained on. Ids from the model's number of event
  /// types on are unknown events; kOtherMode (stream/vocabulary.h) tells a mode that it lacks.
  void addHeldOut(const Recording& recording);

  /// What the recordings said. Findings of some add up to those of all, in any order.
  const evidence::LimitFinder::Findings& findings() const { return finder_.findings(); }
  /// Adds what recordings said elsewhere.
  /// @throw std::invalid_argument if the findings belong to another model
  void merge(const evidence::LimitFinder::Findings& findings) { finder_.merge(findings); }

  /// Finds the limits by all findings; the recordings and the stamp are the caller's to add.
  /// @param budget false alarms an hour that they allow, > 0
  /// @throw std::invalid_argument if there was too little data, or the budget is out of range, in
  /// words
  Calibration find(double budget = evidence::LimitFinder::kBudget) const;

 private:
  Calibrator(std::shared_ptr<const evidence::CrossFit> models,
             const evidence::LimitFinder::Parameters& parameters, const SourceGraph& graph,
             std::optional<std::size_t> only_half);
  void judge(const Recording& recording, std::size_t begin, std::size_t end,
             std::optional<std::size_t> half);

  std::shared_ptr<const evidence::CrossFit> models_;
  evidence::LimitFinder finder_;
  std::optional<std::size_t> only_half_;  // that all recordings of the training belong to
};

/// Learns a model from recordings of normal operation, one after the other: it counts, and a model
/// computes the rest from the counts. They do not depend on the order of the recordings, and add
/// up: what several learners count, in threads, processes or on a cluster, is in sum what one of
/// them counts (Model::add(); docs/method.md, sections 2.1 and 3.1). Limits need a second pass
/// over the recordings: learn() does it with what is in memory; after counts(), it is for a
/// Calibrator.
class Learner {
 public:
  /// What is counted, and how.
  struct Counting {
    bool evidence = true;                  ///< count for the evidence detector
    bool paper = false;                    ///< count for the paper's
    std::int64_t window = kDefaultWindow;  ///< length of the windows to be judged [ns], > 0
    paper::Binning binning;                ///< of the paper's delays
  };
  /// How a model is learned.
  struct Parameters {
    Counting counting;              ///< what for, and the windows' length
    Calibrator::Parameters limits;  ///< how they are found
    evidence::Tuning tuning{};      ///< the numbers of the method
  };

  /// Learns with the default parameters.
  /// @param graph whose messages reach whom; empty: not known
  explicit Learner(SourceGraph graph = {});
  /// @throw std::invalid_argument if a parameter is out of range, or nothing is to be counted
  Learner(const Parameters& parameters, SourceGraph graph);
  ~Learner();

  /// Id of an event type; a new type is added.
  /// @throw std::logic_error after counts() or learn()
  EventId intern(const EventType& type);
  /// The event types so far, by id.
  const Vocabulary& vocabulary() const { return model_.vocabulary(); }

  /// Counts a recording, and keeps nothing else of it.
  /// @throw std::invalid_argument if it has no events; std::logic_error after counts() or learn()
  void count(const Recording& recording);
  /// Counts a recording, and keeps its events for the limits of learn().
  /// @throw as count()
  void add(Recording recording);
  /// Ends the learning: a model of all that was counted. It has no limits, and what it watches is
  /// not chosen yet (Model::watch()).
  /// @throw std::logic_error if it has ended already
  Model counts();
  /// Ends the learning. The model has limits if it was learned for the evidence detector, and
  /// the recordings of add() are long enough: else why() says why not.
  /// @throw std::logic_error if there is no recording, or it has ended already
  Model learn();
  /// Why learn() has found no limits; empty: it has.
  const std::string& why() const { return why_; }

 private:
  struct Trainers;

  /// @throw std::logic_error after counts() or learn()
  void requireOpen() const;
  void startRecording(const Recording& recording, std::uint64_t fingerprint);
  void countEvent(const Event& event);

  Parameters parameters_;
  Model model_;  // what was counted
  std::unique_ptr<Trainers> trainers_;
  std::optional<std::size_t> only_half_;  // that all recordings belong to; none: both, or none yet
  std::optional<std::int64_t> middle_;    // of a recording of two parts [ns], until it is reached
  std::vector<Recording> kept_;
  std::string why_;
};

}  // namespace self_awareness::core
