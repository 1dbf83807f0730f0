#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "self_awareness/core/evidence/statistics.h"
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
  /// For the evidence detector, of each half of the training; without event types if the training
  /// did not count for it. What one half says is tried on the other: this separates what holds in
  /// all recordings from what holds in some (docs/method.md, section 3.1).
  std::array<evidence::Statistics, 2> halves;
};

/// Trains on one recording after the other, event by event.
class Training {
 public:
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
  EventId intern(const EventType& type);
  const Vocabulary& vocabulary() const { return counts_.delays.vocabulary(); }

  /// Starts a recording: the next events belong to it. Recordings belong to the two halves in
  /// turn.
  /// @param since when the recording began [ns], if not all of it is trained on
  /// @param robot_start when the robot was started [ns]; 0: not known
  /// @return the half that this one belongs to, 0 or 1
  std::size_t startRecording(std::optional<std::int64_t> since = std::nullopt,
                             std::int64_t robot_start = 0);
  /// Starts the only recording of a training, which is cut in two: events before `middle` [ns]
  /// belong to the first half, the others to the second. So what holds in one part only is not
  /// taken for information.
  /// @throw std::logic_error if a recording was started before
  void startOnlyRecording(std::int64_t middle, std::optional<std::int64_t> since = std::nullopt,
                          std::int64_t robot_start = 0);
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

  Parameters parameters_;
  TrainingCounts counts_;
  std::unique_ptr<Trainers> trainers_;
  std::size_t recordings_ = 0;
  std::size_t half_ = 0;                // the half that is trained
  std::optional<std::int64_t> middle_;  // of the only recording [ns], until it is reached
  std::int64_t robot_start_ = 0;        // of the only recording [ns]
};

}  // namespace self_awareness::core
