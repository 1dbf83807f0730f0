#include "core/evidence/channel/pairs.h"

#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "core/evidence/channel/delays.h"
#include "core/evidence/channel/sum.h"
#include "core/evidence/watch/arming.h"
#include "self_awareness/core/evidence/channel/model.h"

namespace self_awareness::core::evidence {
namespace {

class ExpectedPairs : public Expectation {
 public:
  ExpectedPairs(const Model& model, std::vector<std::size_t> tracks)
      : Expectation(std::move(tracks)), model_(model) {
    for (std::size_t number = 0; number < this->tracks().size(); ++number) {
      steps_.emplace_back(model, track(number).from, track(number).to);
    }
  }
  std::unique_ptr<ChannelState> start() const override;
  double leastLimit(std::size_t /*track*/) const override { return model_.tuning().least_sum; }
  double limit(std::size_t /*track*/, double largest, double most) const override {
    return limitOfSum(largest, most);
  }
  std::optional<double> leastDelayFound(std::size_t track, double limit) const override;
  const DelaySteps& steps(std::size_t number) const { return steps_[number]; }
  const Model& model() const { return model_; }
  /// The track of a number from 0 on: its event types.
  const Track& track(std::size_t number) const { return model_.tracks()[tracks()[number]]; }

 private:
  const Model& model_;
  std::vector<DelaySteps> steps_;  // by number
};

class PairsState : public ChannelState {
 public:
  explicit PairsState(const ExpectedPairs& expected);

  bool listens() const override { return !pairs_.empty(); }
  void add(const Heard::Arrival& arrival, const Heard& heard) override {
    // Constant local copies: the compiler would look up again what it does not know to be
    // constant.
    const std::int64_t* const stamps = heard.stamps();
    const std::uint64_t* const numbers = heard.numbers();
    const Range range = pairs_of_[arrival.id];
    for (std::uint32_t number = range.begin; number < range.end; ++number) {
      Pair& pair = pairs_[number];
      // Only the first event after another counts: later ones, while the other pauses, would count
      // one pause many times. No branch, since the processor cannot predict which one is first.
      const bool first = numbers[pair.from] >= arrival.last;
      const bool counts = first && !arrival.stalled;
      const double step = (*pair.steps)(arrival.stamp - stamps[pair.from]) * (counts ? 1.0 : 0.0);
      pair.sum.add(step, arrival.stamp);
      if (!pair.armed) {
        arm(number, numbers[pair.from] > 0, counts, step);
      }
    }
  }
  void disarm(EventId id) override {
    for (const std::uint32_t number : with_[id]) {
      clear(number);
      arming_[number].disarm();
    }
  }
  void forget(EventId id) override {
    for (const std::uint32_t number : with_[id]) {
      pairs_[number].sum.value = 0;
      arming_[number].forget();
    }
  }
  void restart() override;
  void capAt(const std::vector<double>& limits) override;
  void closeWindow(const Heard& heard, std::vector<double>& evidence) override;
  std::optional<std::int64_t> onset(std::size_t track) const override {
    return pairOf(track).sum.since;
  }
  double raisedBy(std::size_t track) const override {
    return pairOf(track).armed ? 0 : kUnlimited;
  }
  void explain(std::size_t track, const Heard& heard, const RecentEvents& events,
               Suspect& suspect) const override;

 private:
  // All that an event needs of a pair lies together, and so do the pairs of an event type: most of
  // the time goes into fetching them.
  struct Pair {
    EventId from = 0;
    bool armed = false;
    const DelaySteps* steps = nullptr;
    Sum sum;  // since the stamp of the first delay
  };
  struct Range {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
  };

  /// Takes in a delay of a pair that is not armed. Of one whose other event type was never heard,
  /// what was added to the sum is taken back here: so the many others need no check.
  void arm(std::uint32_t number, bool heard, bool counts, double step);
  const Pair& pairOf(std::size_t track) const {
    return pairs_[pair_of_[expected_.numberOf(track)]];
  }
  void clear(std::uint32_t number) {
    pairs_[number].sum.value = 0;
    pairs_[number].armed = false;
  }

  const ExpectedPairs& expected_;
  double most_of_limit_;
  Arming::Numbers arming_numbers_;
  bool has_limits_ = false;
  std::vector<Pair> pairs_;                       // by `to`
  std::vector<Range> pairs_of_;                   // by id of `to`
  std::vector<std::size_t> track_of_;             // by number of the pair
  std::vector<std::uint32_t> pair_of_;            // number of the pair, by that of its track
  std::vector<Arming> arming_;                    // by number of the pair
  std::vector<std::vector<std::uint32_t>> with_;  // numbers of the pairs of a type, by id
};

std::optional<double> ExpectedPairs::leastDelayFound(std::size_t track, double limit) const {
  const Track& pair = model_.tracks()[track];
  const DelayHistogram delays = model_.learned().delays(pair.from, pair.to);
  const double period = std::max(model_.meanGap(pair.from), model_.meanGap(pair.to));
  const double events = 1e9 * model_.tuning().accept_after / period;
  for (std::size_t bin = 1; bin < kDelayBins && log_bins::middle(bin) < period; ++bin) {
    const double later = log_bins::middle(bin);
    double sum = 0;
    for (std::size_t usual = 0; usual < kDelayBins; ++usual) {
      sum += delays[usual] *
             steps_[numberOf(track)](static_cast<std::int64_t>(log_bins::middle(usual) + later));
    }
    if (sum / static_cast<double>(delays.total()) * events > limit) {
      return later;
    }
  }
  return std::nullopt;
}

std::unique_ptr<ChannelState> ExpectedPairs::start() const {
  return std::make_unique<PairsState>(*this);
}

PairsState::PairsState(const ExpectedPairs& expected)
    : expected_(expected),
      most_of_limit_(expected.model().tuning().most_of_limit),
      arming_numbers_(expected.model().tuning()),
      pair_of_(expected.tracks().size()),
      arming_(expected.tracks().size()),
      with_(expected.model().size()) {
  std::vector<std::vector<std::size_t>> by_to(expected.model().size());
  for (std::size_t number = 0; number < expected.tracks().size(); ++number) {
    by_to[expected.track(number).to].push_back(number);
  }
  for (const std::vector<std::size_t>& of_type : by_to) {
    Range range;
    range.begin = static_cast<std::uint32_t>(pairs_.size());
    for (const std::size_t number : of_type) {
      const auto here = static_cast<std::uint32_t>(pairs_.size());
      const Track& track = expected.track(number);
      with_[track.to].push_back(here);
      with_[track.from].push_back(here);
      track_of_.push_back(expected.tracks()[number]);
      pair_of_[number] = here;
      pairs_.push_back({track.from, false, &expected.steps(number), {}});
    }
    range.end = static_cast<std::uint32_t>(pairs_.size());
    pairs_of_.push_back(range);
  }
}

void PairsState::arm(std::uint32_t number, bool heard, bool counts, double step) {
  if (!heard) {
    pairs_[number].sum.value = 0;
  } else if (counts) {
    arming_[number].add(step - pairs_[number].steps->leastUsual(), arming_numbers_);
    pairs_[number].armed = arming_[number].armed();
  }
}

void PairsState::restart() {
  for (std::uint32_t number = 0; number < pairs_.size(); ++number) {
    clear(number);
    arming_[number] = {};
  }
}

void PairsState::capAt(const std::vector<double>& limits) {
  has_limits_ = true;
  for (std::size_t number = 0; number < pairs_.size(); ++number) {
    pairs_[number].sum.capAt(limits[track_of_[number]], most_of_limit_);
  }
}

void PairsState::closeWindow(const Heard& heard, std::vector<double>& evidence) {
  for (std::uint32_t number = 0; number < pairs_.size(); ++number) {
    Pair& pair = pairs_[number];
    const bool is_abnormal = pair.sum.value * most_of_limit_ > pair.sum.cap;
    if (has_limits_ && arming_[number].fails(is_abnormal, pair.sum.value <= 0, heard.windowEnd(),
                                             arming_numbers_)) {
      clear(number);
    }
    // What grows for longer than news last is a load or a phase that changes slowly.
    if (!is_abnormal && heard.windowEnd() - pair.sum.since > arming_numbers_.accept_after) {
      pair.sum.value = 0;
    }
    evidence[track_of_[number]] = pair.armed ? pair.sum.value : 0;
  }
}

void PairsState::explain(std::size_t track, const Heard& heard, const RecentEvents& events,
                         Suspect& suspect) const {
  const Model& model = expected_.model();
  const EventId to = suspect.id;
  const EventId from = model.tracks()[track].from;
  const Pair& pair = pairOf(track);
  std::vector<SeenDelay> seen;
  std::optional<std::int64_t> since;  // stamp of the last `from`, until a `to` comes after it
  for (const RecentEvents::Remembered& event : events.of(from, to)) {
    if (event.id == from) {
      since = event.stamp;
      continue;
    }
    if (since) {
      const std::int64_t delay = std::max<std::int64_t>(event.stamp - *since, 0);
      const double step = event.stalled ? 0 : (*pair.steps)(delay);
      seen.push_back({event.stamp, static_cast<double>(delay), step});
      since.reset();
    }
  }
  suspect.reason.after = toString(model.vocabulary().at(from));
  suspect.reason.usual_shortest = 1e-9 * model.usualDelay(from, to, 0.05);
  suspect.reason.usual_longest = 1e-9 * model.usualDelay(from, to, 0.95);
  describeDelays(seen, pair.sum.cap, model.usualDelay(from, to, 0.5), heard.windowEnd(),
                 model.tuning(), suspect.reason);
}

}  // namespace

// Of every event type the predecessor that says most of it, one with a reason first, then one that
// the graph says reaches it: recordings of the calibration may give it a reason.
std::vector<Track> Pairs::watch(const Choice& choice) const {
  std::vector<Track> tracks;
  for (EventId to = 0; to < choice.both.size(); ++to) {
    std::optional<std::tuple<bool, bool, double, EventId>> best;
    for (EventId from = 0; from < choice.both.size(); ++from) {
      if (from != to && choice.areEnough(from, to) && choice.saysEnough(from, to)) {
        const Relation reason = choice.relations.delays(from, to);
        const bool is_known = choice.relations.knowGraph() && reason.reaches;
        const std::tuple each{!reason.watched, !is_known, -choice.gains(from, to), from};
        best = std::min(best.value_or(each), each);
      }
    }
    if (best) {
      tracks.push_back({this, to, std::get<EventId>(*best)});
    }
  }
  return tracks;
}

std::unique_ptr<const Expectation> Pairs::expect(const Model& model, const Halves& /*halves*/,
                                                 std::vector<std::size_t> tracks) const {
  return std::make_unique<ExpectedPairs>(model, std::move(tracks));
}

}  // namespace self_awareness::core::evidence
