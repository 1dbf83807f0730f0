#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "self_awareness/core/evidence_model.h"
#include "self_awareness/core/recent_counts.h"

namespace self_awareness::core {

/// Gathers the evidence of every track from the events of one recording (METHOD.md, section 3).
/// Delays and answers are summed up as in Page's CUSUM test: what is usual takes from the sum,
/// what is not adds to it, and below 0 it does not fall. A fault that lasts is found soon, one
/// that comes and goes later, and chance alone hardly gets anywhere.
class EvidenceScorer {
 public:
  /// @param window length [ns] of the windows that rates are counted in
  EvidenceScorer(std::shared_ptr<const EvidenceModel> model, std::int64_t window);

  /// Lets no sum grow far beyond its limit: an alarm must not outlast its cause for long.
  void capAt(const EvidenceLimits& limits);

  /// @param event ids the model does not know are left out
  /// @return delay since the last event of the same type [ns], if there was one
  std::optional<std::int64_t> add(const Event& event);
  /// Closes a window. @param end of the window [ns]. @return evidence by track, 0: none
  const std::vector<double>& closeWindow(std::int64_t end);
  /// Forgets what was seen: another recording, or the clock was set.
  void restart();

  const EvidenceModel& model() const { return *model_; }
  /// When each event type of the model was last seen [ns], by id.
  std::optional<std::int64_t> lastSeen(EventId id) const;
  /// The last delay of a delay track [ns].
  std::int64_t lastDelay(std::size_t track) const { return last_delays_.at(track); }
  /// Events of a type in the last kRateSpan.
  std::uint32_t recentCount(EventId id) const { return counts_.counts().at(id); }
  /// End of the window that was closed last [ns].
  std::int64_t windowEnd() const { return window_end_; }

 private:
  struct Seen {
    std::int64_t stamp = 0;    // [ns]
    std::uint64_t number = 0;  // of the event in the recording
  };

  /// Whether the delays or answers of a track have once been as in training since the start.
  class Arming {
   public:
    /// @param excess of an event over the mean in training
    /// @param usual the largest mean excess that is as in training
    void add(double excess, double usual);
    bool armed() const { return armed_; }

   private:
    double sum_ = 0;
    std::uint32_t events_ = 0;
    bool armed_ = false;
  };

  void disarm(EventId id);

  std::shared_ptr<const EvidenceModel> model_;
  std::vector<std::vector<std::size_t>> delay_tracks_;   // by `to`
  std::vector<std::vector<std::size_t>> answer_tracks_;  // by `from`
  std::vector<std::optional<Seen>> last_seen_;           // by id
  std::uint64_t number_ = 0;
  RecentCounts counts_;
  std::vector<double> sums_;               // of delay and answer tracks, by track
  std::vector<double> caps_;               // of the sums, by track
  std::vector<Arming> arming_;             // of delay and answer tracks, by track
  std::vector<double> evidence_;           // by track
  std::vector<std::int64_t> last_delays_;  // [ns] by track
  std::int64_t window_end_ = 0;            // [ns]
};

/// What a window's evidence comes to.
struct EvidenceSum {
  double largest = 0;  ///< of the tracks, in units of their limits
  double linker = 0;   ///< evidence of all event types together, not in units of its limit
};

/// The largest evidence, and the linker's: the sum over the event types of the largest share of
/// its limit that one of their slow delay and answer tracks has reached, at most 1. It links what
/// is too little for an alarm wherever it is looked at alone (paper, section V-C).
EvidenceSum sumUp(const std::vector<double>& evidence, const EvidenceModel& model,
                  const EvidenceLimits& limits);

}  // namespace self_awareness::core
