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

/// What recordings of normal operation came to: counts, from which a model computes the rest.
/// Those of two trainings add up to those of a training on both.
struct TrainingCounts {
  /// Of the paper's detector; without delays where they were not counted for it.
  paper::DelayStatistics delays{paper::Binning{}};
  /// Of the evidence detector, of the two halves of the training; without event types where they
  /// were not counted for it. What one half says is tried on the other: that tells what holds in
  /// all recordings from what held in some (docs/method.md, section 3.1).
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

  /// The id of an event type, which is added if it is new.
  EventId intern(const EventType& type);
  const Vocabulary& vocabulary() const { return counts_.delays.vocabulary(); }

  /// The next events belong to another recording. Recordings belong to the two halves in turn.
  /// @return the half that this one belongs to, 0 or 1
  std::size_t startRecording();
  /// The only recording of a training is cut in two: what comes before `middle` [ns] belongs to
  /// the first half, the rest to the second. What holds in a part of it only is at least not taken
  /// for information.
  /// @throw std::logic_error if there was a recording before
  void startOnlyRecording(std::int64_t middle);
  /// @param event with an id from intern(); in the order of the recording
  void add(const Event& event);
  /// Hands out what was counted, and ends the training: with many event types, a copy may fill the
  /// memory.
  /// @throw std::logic_error if it has ended
  TrainingCounts finish();

 private:
  struct Trainers;

  Parameters parameters_;
  TrainingCounts counts_;
  std::unique_ptr<Trainers> trainers_;
  std::size_t recordings_ = 0;
  std::size_t half_ = 0;                // that is trained
  std::optional<std::int64_t> middle_;  // of the only recording [ns], while before it
};

}  // namespace self_awareness::core
