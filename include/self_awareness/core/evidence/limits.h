#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "self_awareness/core/evidence/block_maxima.h"
#include "self_awareness/core/evidence/model.h"
#include "self_awareness/core/stream/windows.h"

namespace self_awareness::core::evidence {

/// The limit that the largest value of a block exceeds with a small probability: a Gumbel
/// distribution is fitted to the maxima of blocks by L-moments (Hosking 1990), and extrapolated.
/// @param maxima of at least two blocks
/// @param probability 0 to 1
double gumbelLimit(const BlockMaxima& maxima, double probability);

/// The age [ns] that gaps between two events of a type reach less often than a rate: the excess of
/// the longest gaps over the shortest of them is taken for exponential, and extrapolated.
/// @param longest_gaps [ns], the longest first, at least two
/// @param duration in which they were the longest [ns]
/// @param rate per nanosecond
double overdueAge(const std::vector<std::int64_t>& longest_gaps, std::int64_t duration,
                  double rate);

class MisleadingPairs;
class Scorer;

/// Finds the limits of a model's evidence on normal operation that was not trained on, so that
/// those of the tracks together are exceeded less often than a number of times an hour; and in a
/// second pass over the same recordings that of the linker, for the same number of its own.
class LimitFinder : private WindowObserver {
 public:
  struct Parameters {
    std::int64_t window = kDefaultWindow;   ///< length of a window [ns]
    std::int64_t settle_time = 5000000000;  ///< left out at a recording's start [ns]
    double false_alarms_per_hour = 0.5;     ///< all together, > 0

    /// @throw std::invalid_argument if a value is out of range.
    void validate() const;
  };

  /// What recordings say in one pass. That of some recordings and that of others add up to that of
  /// all, in any order; it does not grow with their length.
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

  /// The next events belong to another recording, which is judged by a model: that of the
  /// constructor, or one learned from the other half of the training, with the same tracks.
  void startRecording(std::shared_ptr<const Model> model);
  void add(const Event& event);
  /// The recording ends.
  void finish();
  /// Ends the first pass: the limits of the tracks are found, and recordings come once more.
  /// @throw std::invalid_argument if there was too little data: less than kFewestBlocks blocks, or
  /// so little to train on that the model has no tracks
  void startSecondPass();
  /// Begins with the second pass, by what a first one elsewhere found.
  /// @throw std::invalid_argument if that belongs to another model
  void startSecondPass(Limits limits);
  /// What the recordings said that have ended, in this pass and those before.
  Findings findings() const;
  /// Adds what recordings said elsewhere, in the pass that goes on here.
  /// @throw std::invalid_argument if it belongs to another model
  void merge(const Findings& other);
  /// Limits of the tracks alone, once the second pass has begun: the linker's is still missing.
  const Limits& trackLimits() const { return limits_; }
  /// @throw std::logic_error before the second pass
  Limits limits() const;

  const Parameters& parameters() const { return parameters_; }
  bool inSecondPass() const { return second_pass_; }
  /// Windows that were looked at, of one pass.
  std::uint64_t windows() const { return windows_seen_; }

  /// The maxima are those of blocks of this length [ns]: longer than evidence remembers.
  static constexpr std::int64_t kBlock = 10 * kNanosecondsPerSecond;
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
