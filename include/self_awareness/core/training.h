#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "self_awareness/core/evidence/count/halves.h"
#include "self_awareness/core/evidence/count/statistics.h"
#include "self_awareness/core/evidence/count/trainer.h"
#include "self_awareness/core/paper/binning.h"
#include "self_awareness/core/paper/delay_statistics.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/stream/windows.h"

namespace self_awareness::core {

/// What a training learns from recordings of normal operation: counts. A model computes the rest
/// from them. The counts of two trainings add up to those of a training on both (docs/method.md,
/// sections 2.1 and 3.1).
struct TrainingCounts {
  /// For the paper's detector; without delays if the training did not count for it.
  paper::DelayStatistics delays{paper::Binning{}};
  /// For the evidence detector; without event types if the training did not count for it.
  evidence::Halves halves;
  /// The half that all recordings belong to; none: there are some of both.
  std::optional<std::size_t> only_half;
};

/// Trains on one recording after the other, event by event.
class Training {
 public:
  /// What is counted, and how.
  struct Parameters {
    bool evidence = true;                  ///< count for the evidence detector
    bool paper = false;                    ///< count for the paper's
    std::int64_t window = kDefaultWindow;  ///< length of the windows to be judged [ns], > 0
    paper::Binning binning;                ///< of the paper's delays
  };

  /// @throw std::invalid_argument if a parameter is out of range, or nothing is to be counted
  explicit Training(const Parameters& parameters);
  ~Training();

  /// Id of an event type; a new type is added.
  /// @throw std::logic_error after finish()
  EventId intern(const EventType& type);
  /// The event types so far, by id.
  const Vocabulary& vocabulary() const { return counts_.delays.vocabulary(); }

  /// What a training must know of a recording.
  struct Recording {
    /// Any number of its own: it says which half of the training the recording belongs to.
    std::uint64_t fingerprint = 0;
    /// Where its second part begins [ns]; each part is counted by itself as long as all recordings
    /// belong to one half.
    std::int64_t middle = 0;
    /// When the recording began [ns], if not all of it is trained on.
    std::optional<std::int64_t> since;
    std::int64_t robot_start = 0;  ///< when the robot was started [ns]; 0: not known
    std::string robot{};           ///< its name; empty: not known
    std::vector<evidence::MachineStall> stalls{};  ///< of its machine, in their order
  };

  /// Starts a recording: the next events belong to it.
  /// @throw std::logic_error after finish()
  void startRecording(const Recording& recording);
  /// The clock was set, which the stamps do not say by themselves (stream/clock_steps.h): no delay
  /// crosses from before.
  void onClockStep();
  /// An event of the recording before those that are trained on: it only says when its type comes
  /// first.
  void addBefore(const Event& event);
  /// @param event with an id from intern(); in the order of the recording
  void add(const Event& event);
  /// Ends the training and gives its counts away: with many event types, a copy of them may fill
  /// the memory.
  /// @throw std::logic_error if the training has ended already
  TrainingCounts finish();

 private:
  struct Trainers;

  /// @throw std::logic_error after finish()
  void requireOpen() const;

  Parameters parameters_;
  TrainingCounts counts_;
  std::unique_ptr<Trainers> trainers_;
  bool started_ = false;                // a recording
  std::optional<std::int64_t> middle_;  // of a recording of two parts [ns], until it is reached
};

}  // namespace self_awareness::core
