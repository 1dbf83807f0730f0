#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/evidence/watch/relation.h"
#include "self_awareness/core/stream/waiting.h"
#include "self_awareness/core/stream/windows.h"
#include "self_awareness/core/verdict/source_graph.h"

namespace self_awareness::core::evidence {

class MisleadingPairs;
class Scorer;

/// Finds the limits of a model's evidence on recordings of normal operation (docs/method.md,
/// section 5). A number of false alarms an hour is allowed to all of them together.
class LimitFinder : private WindowObserver {
 public:
  /// How limits are found.
  struct Parameters {
    std::int64_t window = kDefaultWindow;   ///< length of a window [ns]
    std::int64_t settle_time = 5000000000;  ///< left out at a recording's start [ns]

    /// @throw std::invalid_argument if a value is out of range.
    void validate() const;
  };

  /// False alarms an hour that limits allow by default.
  static constexpr double kBudget = 0.5;
  /// What is known of robots says as much of one's false alarms as so many hours of it.
  static constexpr double kHoursOfRobots = 0.5;

  /// What one recording says. It is cut into at most kMostParts parts of one length.
  struct Recording {
    std::int64_t start = 0;        ///< stamp of the first event [ns]
    std::int64_t end = 0;          ///< stamp of the last one [ns]
    std::int64_t robot_start = 0;  ///< when the robot was started [ns]; 0: not known
    bool trained_on = false;       ///< it was judged by what the other half of the training says
    std::uint64_t windows = 0;     ///< looked at
    /// A part of it.
    struct Part {
      std::uint64_t windows = 0;    ///< looked at
      std::vector<float> evidence;  ///< the largest, by track; 0 for silences
      /// [ns], by id; 0: none. Of who is often silent, also what the recording cuts off.
      std::vector<std::int64_t> longest_gaps;
    };
    std::vector<Part> parts;  ///< in order; the last one may be shorter
    std::vector<Said> said;   ///< by track
    /// From the start of a recording that was not trained on, or since the clock was set, to the
    /// first event of a type [ns], by id; -1: it did not come. Empty where the clock was set
    /// afterwards: what follows says it.
    std::vector<std::int64_t> firsts{};
    std::string robot{};  ///< its name; empty: not known
  };
  /// What recordings say. Findings of some add up to those of all, in any order.
  using Findings = std::vector<Recording>;

  /// @param graph who hears whom
  LimitFinder(std::shared_ptr<const Model> model, const Parameters& parameters,
              SourceGraph graph = {});
  ~LimitFinder() override;

  /// Starts a recording: the next events belong to it.
  /// @param model that judges it: that of the constructor, or one with the same tracks that was
  /// learned from the other half of the training (CrossFit)
  /// @param robot_start when the robot was started [ns]; 0: not known
  /// @param robot its name; empty: not known
  void startRecording(std::shared_ptr<const Model> model, std::int64_t robot_start = 0,
                      std::string robot = {});
  /// Takes in the next event of the recording.
  void add(const Event& event);
  /// Takes in how the machine was in a stretch of time; as Detector::hear(). After who measured it
  /// stood still, nothing counts for settle_time.
  void hear(const Waiting& waiting);
  /// The clock was set, which the stamps do not say by themselves (stream/clock_steps.h).
  void restart();
  /// Ends the recording.
  void finish();
  /// What the recordings that have ended said.
  const Findings& findings() const { return findings_; }
  /// Adds what recordings said elsewhere.
  /// @throw std::invalid_argument if the findings belong to another model
  void merge(const Findings& other);

  /// What comes of the findings.
  struct Found {
    Limits limits;  ///< the largest evidence that is normal
    /// False alarms an hour that no more are to be expected than with these limits (95 %): what
    /// recordings show that are left out in turn.
    double promised_rate = 0;
    /// What speaks for the relation that a track watches, by track; what looks at one event type
    /// is always watched.
    std::vector<Relation> relations;
  };
  /// Finds the limits by all findings.
  /// @param budget false alarms an hour that they allow, > 0
  /// @throw std::invalid_argument if there was too little data: less than its tuning asks for, or
  /// so little to train on that the model has no tracks; or if the budget is out of range
  Found find(double budget = kBudget) const;

  /// As given to the constructor.
  const Parameters& parameters() const { return parameters_; }
  /// Who hears whom.
  const SourceGraph& graph() const { return graph_; }
  /// Number of windows that were looked at.
  std::uint64_t windows() const;

  /// Of a recording.
  static constexpr std::size_t kMostParts = 16;

 private:
  std::optional<ObservedEvent> observe(const Event& event) override;
  void close(const Window& window, std::int64_t end) override;
  void onClockStep() override;
  void endRecording();
  /// The latest of the first events, of all recordings that were not trained on; as in Limits.
  std::vector<std::int64_t> latestFirsts() const;
  void startScoring();
  /// Whether all has settled since who recorded it stood still. @param stamp [ns]
  bool hasSettled(std::int64_t stamp) const {
    return stood_still_until_ == 0 || stamp >= stood_still_until_ + parameters_.settle_time;
  }
  /// Forgets attributes of event types that have settled, as the detector does: their first
  /// messages may be odd.
  /// @param now start of the window [ns]
  void forgetStarts(std::int64_t now);
  /// Takes in the time before the first event of a type, or after its last one [ns], and what is
  /// waiting of it, if that says something (heads_and_tails.h).
  void endHeadOrTail(EventId id, std::int64_t length);
  void startPart();
  /// Joins neighbouring parts: they then last twice as long.
  void joinParts();
  std::vector<Relation> findRelations() const;

  std::shared_ptr<const Model> model_;
  Parameters parameters_;
  SourceGraph graph_;
  std::shared_ptr<const Model> judging_;
  std::unique_ptr<Scorer> scorer_;
  Windows windows_;
  std::int64_t robot_start_ = 0;             // of the recording [ns]; 0: not known
  std::string robot_;                        // of the recording; empty: not known
  std::optional<std::int64_t> first_stamp_;  // of the recording, or since a step of the clock [ns]
  std::int64_t stood_still_until_ = 0;       // who recorded it [ns]; 0: it never did
  std::vector<std::int64_t> firsts_;         // of the recording, as in Recording
  std::vector<std::int64_t> settled_at_;     // when an event type has settled [ns], by id
  std::vector<EventId> settling_;            // those that have not
  std::vector<bool> heard_now_;              // in the open window, by id
  // The largest evidence since a type was heard last, by track: it counts when the type is heard
  // again, as nobody knows what of a silence that the recording cuts off is normal.
  std::vector<float> waiting_;
  Recording recording_;             // the open one
  std::uint64_t part_windows_ = 0;  // length of its parts
  std::unique_ptr<MisleadingPairs> misleading_;

  Findings findings_;
};

}  // namespace self_awareness::core::evidence
