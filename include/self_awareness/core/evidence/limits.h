#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "self_awareness/core/evidence/block_maxima.h"
#include "self_awareness/core/evidence/model.h"
#include "self_awareness/core/stream/windows.h"

namespace self_awareness::core::evidence {

/// Limit that the largest value of a block exceeds with a small probability: a Gumbel distribution
/// is fitted to the maxima of blocks by L-moments (Hosking 1990), and extrapolated
/// (docs/method.md, section 5.3).
/// @param maxima of at least two blocks
/// @param probability 0 to 1
double gumbelLimit(const BlockMaxima& maxima, double probability);

/// Age [ns] that gaps between two events of a type reach less often than a rate says: the excess
/// of the longest gaps over the shortest of them is taken for exponential, and extrapolated
/// (docs/method.md, section 5.2).
/// @param longest_gaps [ns], the longest first, at least two
/// @param duration in which they were the longest [ns]
/// @param rate of such gaps [1/ns]
double overdueAge(const std::vector<std::int64_t>& longest_gaps, std::int64_t duration,
                  double rate);

class MisleadingPairs;
class Scorer;

/// Finds the limits of a model's evidence on recordings of normal operation (docs/method.md,
/// section 5). The first pass finds those of the tracks: for all of them together, a number of
/// false alarms an hour is allowed. The second pass over the same recordings finds that of the
/// linker, which is allowed the same number again.
class LimitFinder : private WindowObserver {
 public:
  struct Parameters {
    std::int64_t window = kDefaultWindow;   ///< length of a window [ns]
    std::int64_t settle_time = 5000000000;  ///< left out at a recording's start [ns]
    double false_alarms_per_hour = 0.5;     ///< allowed in each pass, > 0

    /// @throw std::invalid_argument if a value is out of range.
    void validate() const;
  };

  /// What recordings say. Findings of parts of the recordings add up to those of all, in any
  /// order. They do not grow with the length of the recordings.
  struct Findings {
    std::uint64_t windows = 0;        ///< looked at in the first pass
    std::int64_t duration = 0;        ///< [ns]
    std::uint64_t blocks = 0;         ///< of the first pass
    std::vector<BlockMaxima> maxima;  ///< largest evidence of blocks, by track; none for overdue
    std::vector<std::vector<std::int64_t>> longest_gaps;  ///< [ns], by id
    std::vector<bool> misleading;                         ///< by track
    BlockMaxima linker_maxima;                            ///< of the second pass
  };

  LimitFinder(std::shared_ptr<const Model> model, const Parameters& parameters);
  ~LimitFinder() override;

  /// Starts a recording: the next events belong to it.
  /// @param model that judges it: that of the constructor, or one with the same tracks that was
  /// learned from the other half of the training (CrossFit)
  void startRecording(std::shared_ptr<const Model> model);
  void add(const Event& event);
  /// Ends the recording.
  void finish();
  /// Ends the first pass and finds the limits of the tracks. All recordings must then come once
  /// more.
  /// @throw std::invalid_argument if there was too little data: fewer than kFewestBlocks blocks,
  /// or so little to train on that the model has no tracks
  void startSecondPass();
  /// Starts the second pass with the limits that a first one elsewhere found.
  /// @throw std::invalid_argument if they belong to another model
  void startSecondPass(Limits limits);
  /// What the recordings that have ended said, in this pass and those before.
  Findings findings() const;
  /// Adds what recordings said elsewhere, in the same pass as here.
  /// @throw std::invalid_argument if the findings belong to another model
  void merge(const Findings& other);
  /// Limits of the tracks alone, once the second pass has started: the linker's is still missing.
  const Limits& trackLimits() const { return limits_; }
  /// Limits of the tracks and of the linker.
  /// @throw std::logic_error before the second pass, or if it has had fewer than two blocks so far
  Limits limits() const;

  const Parameters& parameters() const { return parameters_; }
  bool inSecondPass() const { return second_pass_; }
  /// Number of windows that were looked at, in one pass.
  std::uint64_t windows() const { return windows_seen_; }

  /// Length of the blocks [ns]: longer than evidence remembers.
  static constexpr std::int64_t kBlock = 10 * kNanosecondsPerSecond;
  /// Fewer blocks are too little to find limits.
  static constexpr std::uint64_t kFewestBlocks = 5;

 private:
  ObservedEvent observe(const Event& event) override;
  void close(const Window& window, std::int64_t end) override;
  void onClockStep() override;
  void endRecording();
  void startScoring();
  void closeBlock();
  double meanGap(EventId id) const;  // of training [ns]
  /// @param rate false alarms an hour that the track may raise
  double limit(std::size_t track, double rate) const;

  std::shared_ptr<const Model> model_;
  Parameters parameters_;
  std::shared_ptr<const Model> judging_;
  std::unique_ptr<Scorer> scorer_;
  Windows windows_;
  std::optional<std::int64_t> first_stamp_;  // of the recording [ns]
  std::int64_t last_stamp_ = 0;              // [ns], once there was a first
  std::uint64_t windows_seen_ = 0;

  std::vector<double> block_;  // largest evidence, by track
  std::size_t block_windows_ = 0;
  std::uint64_t blocks_ = 0;
  std::vector<BlockMaxima> maxima_;     // by track, none for overdue
  std::vector<Statistics::Type> gaps_;  // longest gaps, by id
  std::int64_t duration_ = 0;           // [ns]
  std::unique_ptr<MisleadingPairs> misleading_;

  bool second_pass_ = false;
  Limits limits_;
  double linker_block_ = 0;
  BlockMaxima linker_maxima_;
};

}  // namespace self_awareness::core::evidence
