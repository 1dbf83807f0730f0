#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "self_awareness/core/evidence/model.h"
#include "self_awareness/core/stream/recent_counts.h"

namespace self_awareness::core::evidence {

/// Share of a mean over some time that a value makes which came so long after the one before;
/// both in [ns].
constexpr double shareOf(std::int64_t time, std::int64_t elapsed) {
  return static_cast<double>(std::clamp<std::int64_t>(elapsed, 0, time)) /
         static_cast<double>(time);
}

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
  /// Time since the last event of a type, at the end of the last window [ns]; 0 before the first.
  /// While the whole robot is silent for a moment, nobody's silence grows.
  std::int64_t age(EventId id) const {
    const std::int64_t stall =
        stall_ > 0 || window_end_ >= stalled_until_ + kRateSpan || stamps_.at(id) > stalled_from_
            ? stall_
            : stalled_at_ - stalled_from_;
    return numbers_.at(id) > 0 ? window_end_ - stamps_[id] - stall : 0;
  }
  /// Time since the first request without an answer of a deadline track [s], or the number of such
  /// requests (Model::countsRequests()), at the end of the last window.
  double waiting(std::size_t track) const { return evidence_.at(track); }
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
    std::uint32_t failures = 0;  // to be as in training; every one doubles the events it takes
  };
  /// Sums that stay between 0 and a cap.
  struct Sums {
    Eigen::Array2d values = Eigen::Array2d::Zero();
    Eigen::Array2d caps = Eigen::Array2d::Zero();
    template <typename Steps>
    void add(const Steps& steps) {
      values = (values + steps).min(caps).max(0.0);
    }
  };
  // All that an event needs of a pair lies together, and so do the pairs of an event type: most of
  // the time goes into fetching them.
  /// State of the two delay tracks of a pair of event types.
  struct DelayPair {
    EventId from = 0;
    bool own = false;  // `from` is `to`
    bool armed = false;
    const double* surprises = nullptr;  // by bin
    double regime = 0;                  // mean surprise of the last minutes, if it is above usual
    Sums sums;                          // of the track, and of the slow one
  };
  /// State of an answer track.
  struct Answer {
    EventId to = 0;
    bool armed = false;
    bool asked = false;            // since the start
    std::int64_t asked_at = 0;     // stamp of the last question [ns]
    std::uint64_t seen = 0;        // events of `to` up to then
    std::int64_t usual_delay = 0;  // [ns]; what asks again sooner asks nothing new
    double owed = 0;               // answers that did not come, and may still come back
    double answered = 0;           // steps of the sum
    double missed = 0;
    double usual = 0;  // share that is missed
    double sum = 0;
    double cap = 0;
  };
  /// State of a deadline track.
  struct Deadline {
    EventId to = 0;
    bool in_requests = false;    // else in seconds
    std::uint32_t requests = 0;  // without an answer
    std::int64_t since = 0;      // stamp of the first of them [ns], if there is one
  };

  /// Where the pairs, answers and deadlines of an event type lie, and after how long a gap [ns] it
  /// was gone.
  struct OfType {
    std::uint32_t pairs_begin = 0;
    std::uint32_t pairs_end = 0;
    std::uint32_t answers_begin = 0;
    std::uint32_t answers_end = 0;
    std::uint32_t deadlines_begin = 0;
    std::uint32_t deadlines_end = 0;
    std::vector<std::uint32_t> answered_deadlines;  // whose `to` it is
    std::int64_t gone_after = 0;
    double mean_gap = 0;  // [ns]
  };

  /// Takes in one event of a track that is not armed.
  /// @param usual largest mean excess that counts as in training
  /// @return whether the track is armed now
  bool arm(Arming& arming, double excess, double usual) const;
  void addTracks();
  /// Takes in a delay of a pair that is not armed.
  /// @param first whether it counts
  void armPair(std::size_t number, bool first, double surprise);
  /// Takes in a question.
  void ask(std::size_t answer, std::int64_t stamp);
  /// Forgets the sums of all tracks with the type, and lets them be armed again.
  void disarm(EventId id);
  void disarmPair(std::size_t number);
  void disarmAnswer(std::size_t number);
  /// Takes in the gap before an event that is not the first of its type: how far the type is
  /// behind its own mean gaps.
  /// @return whether the gap is shorter for that reason
  bool catchUp(const Event& event);
  /// Takes in the time since the last event of any type: a whole robot that stops for a moment and
  /// goes on has a busy machine, and no component is to blame.
  void noteStall(std::int64_t stamp);
  /// Accepts what has been abnormal for long, and is stable: it is news once.
  void accept(std::int64_t end);

  std::shared_ptr<const Model> model_;
  // Of the model's tuning, as an event needs them.
  double drift_ = 0;
  std::int64_t regime_ = 0;  // [ns]
  std::uint32_t arming_events_ = 0;
  std::uint32_t most_failures_ = 0;
  double usual_surprise_ = 0;
  double most_behind_ = 0;
  std::int64_t longest_stall_ = 0;                  // [ns]
  std::int64_t between_stalls_ = 0;                 // [ns]
  std::int64_t start_time_ = 0;                     // [ns]
  std::vector<OfType> types_;                       // by id
  std::vector<DelayPair> pairs_;                    // by `to`
  std::vector<const Model::Harmless*> harmless_;    // by number of the pair
  std::vector<Answer> answers_;                     // by `from`
  std::vector<Deadline> deadlines_;                 // by `from`
  std::vector<Arming> pairs_arming_;                // by number of the pair
  std::vector<Arming> answers_arming_;              // by number of the answer
  std::vector<std::int64_t> pairs_abnormal_since_;  // [ns] by number of the pair; 0: it is normal
  std::vector<std::int64_t> answers_abnormal_since_;  // [ns] by number of the answer; 0: likewise
  std::vector<std::size_t> state_of_;                 // number of its pair, answer..., by track
  std::vector<std::vector<std::size_t>> tracks_of_;   // delay and answer tracks, by id
  bool has_limits_ = false;
  std::int64_t longest_silence_ = 0;        // that is usual [ns]
  std::int64_t start_ = 0;                  // stamp of the first event [ns], once there was one
  std::int64_t last_stamp_ = 0;             // [ns], once there was an event
  std::int64_t stall_ = 0;                  // that goes on at the end of the last window [ns]
  std::int64_t stalled_from_ = 0;           // begin of the last stall [ns]
  std::int64_t stalled_at_ = 0;             // end of the last stall [ns]; 0: none
  std::int64_t stalled_until_ = 0;          // what waited has come by then [ns]
  std::vector<std::int64_t> stamps_;        // of the last event [ns], by id
  std::vector<std::int64_t> first_stamps_;  // of the first event since the start [ns], by id
  std::vector<double> behind_;              // its mean gaps [ns], by id
  std::vector<std::uint64_t> numbers_;      // of the last event in the recording, by id; 0: none
  std::vector<std::uint64_t> seen_;         // events since the start, by id
  std::uint64_t number_ = 0;
  RecentCounts counts_;
  std::vector<double> evidence_;  // by track
  std::int64_t window_end_ = 0;   // [ns]
};

/// The evidence of a window, summed up.
struct Sum {
  double largest = 0;  ///< of the tracks, in units of their limits
  double linker = 0;   ///< evidence of all components together, not in units of its limit
};

/// Finds the largest evidence and the linker's (docs/method.md, sections 3.8 and 4.1). The
/// linker's is a sum over components: of the largest share of its limit that a slow delay or
/// answer track of the component has reached, from 0 at half the limit to 1 at the limit. It links
/// evidence that is too weak for an alarm in any one place (paper, section V-C).
Sum sumUp(const std::vector<double>& evidence, const Model& model, const Limits& limits);

}  // namespace self_awareness::core::evidence
