#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "self_awareness/core/evidence/model.h"
#include "self_awareness/core/stream/recent_counts.h"

namespace self_awareness::core::evidence {

/// What every delay takes from the sum of its track, in standard deviations: a large drift finds
/// strong evidence without false alarms.
constexpr double kDrift = 1;

/// Collects the evidence of every track from the events of one recording (docs/method.md, sections
/// 3.2 to 3.5 and 3.7). Delays and answers are summed up as in Page's CUSUM test: what is usual
/// takes from the sum, what is unusual adds to it, and the sum never falls below 0. A fault that
/// lasts is found soon, one that comes and goes is found later, and chance alone hardly adds up.
class Scorer {
 public:
  /// @param window length [ns] of the windows that rates are counted in
  Scorer(std::shared_ptr<const Model> model, std::int64_t window);

  /// Caps every sum a little above its limit: an alarm must not last much longer than its cause.
  void capAt(const Limits& limits);

  /// @param event ignored if the model does not know its id
  /// @return delay since the last event of the same type [ns], if there was one
  std::optional<std::int64_t> add(const Event& event);
  /// Closes a window.
  /// @param end of the window [ns]
  /// @return evidence by track; 0: none
  const std::vector<double>& closeWindow(std::int64_t end);
  /// Forgets what was seen: a new recording starts, or the clock was set.
  void restart();

  const Model& model() const { return *model_; }
  /// Stamp of the last event of a type of the model [ns]; none before the first.
  std::optional<std::int64_t> lastSeen(EventId id) const;
  /// The most that the sum of a delay or answer track may be.
  double cap(std::size_t track) const;
  /// Events of a type in the last kRateSpan.
  std::uint32_t recentCount(EventId id) const { return counts_.counts().at(id); }
  /// End of the window that was closed last [ns].
  std::int64_t windowEnd() const { return window_end_; }

 private:
  /// Whether the delays or answers of a track have once been as in training since the start.
  struct Arming {
    double excess = 0;  // of the last events over the mean in training
    std::uint32_t events = 0;
  };
  /// Sums that stay between 0 and a cap.
  template <int kSize>
  struct Sums {
    using Array = Eigen::Array<double, kSize, 1>;
    Array values = Array::Zero();
    Array caps = Array::Zero();
    template <typename Steps>
    void add(const Steps& steps) {
      values = (values + steps).min(caps).max(0.0);
    }
  };
  // All that an event needs of a pair or of a block of answers lies together, and so do the pairs
  // and blocks of an event type: most of the time goes into fetching them.
  /// State of the two delay tracks of a pair of event types.
  struct DelayPair {
    EventId from = 0;
    bool armed = false;
    const double* surprises = nullptr;  // by bin
    Sums<2> sums;                       // of the track, and of the slow one
  };
  /// State of several answer tracks with the same `from`. The processor predicts the end of a loop
  /// over blocks better than that of one over tracks. A block with fewer tracks is filled up with
  /// answers that add nothing.
  struct AnswerBlock {
    static constexpr int kAnswers = 4;
    std::array<EventId, kAnswers> to{};
    std::uint32_t unarmed = 0;  // a bit for each
    Eigen::Array4d answered = Eigen::Array4d::Zero();
    Eigen::Array4d missed = Eigen::Array4d::Zero();
    Sums<kAnswers> sums;

    bool armed(std::size_t answer) const { return (unarmed >> answer & 1U) == 0; }
  };

  /// Where the pairs and blocks of answers of an event type lie, and after how long a gap [ns] it
  /// was gone.
  struct OfType {
    std::uint32_t pairs_begin = 0;
    std::uint32_t pairs_end = 0;
    std::uint32_t blocks_begin = 0;
    std::uint32_t blocks_end = 0;
    std::int64_t gone_after = 0;
  };

  /// Takes in one event of a track that is not armed.
  /// @param usual largest mean excess that counts as in training
  /// @return whether the track is armed now
  static bool arm(Arming& arming, double excess, double usual);
  void addTracks();
  /// @param tracks all answer tracks of the `from`
  void addAnswers(EventId from, const std::vector<std::size_t>& tracks);
  /// Takes in a delay of a pair that is not armed.
  /// @param first whether it counts
  void armPair(std::size_t number, bool first, double surprise);
  /// Takes in an event for the answers of a block that are not armed.
  /// @param since number of the last event of the same type
  void armAnswers(std::size_t block, double since);
  void disarm(EventId id);
  void disarmPair(std::size_t number);
  void disarmAnswer(std::size_t number);

  std::shared_ptr<const Model> model_;
  std::vector<OfType> types_;                        // by id
  std::vector<DelayPair> pairs_;                     // by `to`
  std::vector<AnswerBlock> blocks_;                  // by `from`
  std::vector<Arming> pairs_arming_;                 // by number of the pair
  std::vector<Arming> answers_arming_;               // by number of the answer
  std::vector<double> miss_rates_;                   // by number of the answer
  std::vector<std::size_t> state_of_;                // number of its pair or answer, by track
  std::vector<std::vector<std::size_t>> tracks_of_;  // delay and answer tracks, by id
  std::vector<std::int64_t> stamps_;                 // of the last event [ns], by id
  // Number of the last event in the recording, by id, in steps of kMoreThanAnyStep; 0: never seen.
  // Steps of answers are made of them, so they are doubles: exact for 2^43 events.
  std::vector<double> numbers_;
  double number_ = 0;
  RecentCounts counts_;
  std::vector<double> evidence_;  // by track
  std::int64_t window_end_ = 0;   // [ns]
};

/// The evidence of a window, summed up.
struct Sum {
  double largest = 0;  ///< of the tracks, in units of their limits
  double linker = 0;   ///< evidence of all event types together, not in units of its limit
};

/// Finds the largest evidence and the linker's (docs/method.md, sections 3.6 and 4.1). The
/// linker's is a sum over event types: of the largest share of its limit, at most 1, that a slow
/// delay or answer track of the type has reached. It links evidence that is too weak for an alarm
/// in any one place (paper, section V-C).
Sum sumUp(const std::vector<double>& evidence, const Model& model, const Limits& limits);

}  // namespace self_awareness::core::evidence
