#include "core/evidence/channel/pace.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/evidence/channel/sum.h"
#include "core/evidence/count/log_bins.h"
#include "self_awareness/core/evidence/channel/model.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::uint32_t kNoNumber = std::numeric_limits<std::uint32_t>::max();
// Mean gaps: a longer one, by a bin, makes its type late.
constexpr double kLateGap = log_bins::kInOctave[1];
// More than that is not made up for [ns].
constexpr auto kMostBehind = static_cast<double>(kRateSpan);
// Messages of one stamp took some time, too [s].
constexpr double kLeastTime = 1e-3;
// Other paces, in bins of a quarter of an octave: 0.7 of the rate or a half; and 1.4, 2 or more,
// up to 4096 times the rate. What is still slower is a silence again and again.
constexpr std::ptrdiff_t kTwice = log_bins::kInOctave.size();
constexpr std::ptrdiff_t kSlightly = kTwice / 2;
constexpr std::ptrdiff_t kMostBins = log_bins::kBins - 2;

/// The same gaps, longer by so many bins; what would leave the bins stays in the outermost one.
ByBin longer(const ByBin& shares, std::ptrdiff_t bins) {
  constexpr std::ptrdiff_t kLast = kDelayBins - 1;
  ByBin moved{};
  for (std::size_t bin = 0; bin < shares.size(); ++bin) {
    const auto to = std::clamp(static_cast<std::ptrdiff_t>(bin) + bins, std::ptrdiff_t{0}, kLast);
    moved[static_cast<std::size_t>(to)] += shares[bin];
  }
  return moved;
}

/// What each gap adds to the sum [nat], by bin: half of them are of another pace.
ByBin stepsOf(const DelayHistogram& gaps, Pace::Side side, const Tuning& tuning) {
  ByBin usual = gaps.probabilities();
  // What is a bin longer or shorter is no other pace.
  const ByBin a_bin_longer = longer(usual, 1);
  const ByBin a_bin_shorter = longer(usual, -1);
  for (std::size_t bin = 0; bin < usual.size(); ++bin) {
    usual[bin] = usual[bin] / 2 + (a_bin_longer[bin] + a_bin_shorter[bin]) / 4;
  }
  ByBin steps{};
  const bool is_slower = side == Pace::Side::kSlower;
  const auto addPace = [&](std::ptrdiff_t bins, double share) {
    const ByBin moved = longer(usual, is_slower ? bins : -bins);
    for (std::size_t bin = 0; bin < steps.size(); ++bin) {
      steps[bin] += share * moved[bin] / usual[bin];
    }
  };
  addPace(kSlightly, is_slower ? 1.0 / 2 : 1.0 / 3);
  addPace(kTwice, is_slower ? 1.0 / 2 : 1.0 / 3);
  for (std::ptrdiff_t bins = kTwice + 1; !is_slower && bins <= kMostBins; ++bins) {
    addPace(bins, 1.0 / 3 / (kMostBins - kTwice));
  }
  for (double& step : steps) {
    step = stepOfSum(step, tuning.least_sum);
  }
  return steps;
}

/// How much gaps as in training speak against the other pace, all of them together [nat].
double toldBy(const DelayHistogram& gaps, const ByBin& steps) {
  double told = 0;
  for (std::size_t bin = 0; bin < steps.size(); ++bin) {
    told -= steps[bin] * gaps[bin];
  }
  return told;
}

class ExpectedPaces : public Expectation {
 public:
  ExpectedPaces(const Model& model, std::vector<std::size_t> tracks, Pace::Side side);

  std::unique_ptr<ChannelState> start() const override;
  double leastLimit(std::size_t track) const override { return least_[numberOf(track)]; }
  double limit(std::size_t /*track*/, double largest, double most) const override {
    return limitOfSum(largest, most);
  }
  double step(std::size_t number, std::int64_t gap) const {
    return steps_[number][log_bins::bin(gap)];
  }
  const Model& model() const { return model_; }
  double meanGap(std::size_t number) const { return mean_gaps_[number]; }  // [ns]
  EventId typeOf(std::size_t number) const { return model_.tracks()[tracks()[number]].to; }
  /// Whether so many gaps in such a time [ns] are fewer, or more, than usual.
  bool isOtherRate(std::size_t number, std::uint32_t gaps, double time) const {
    const double usual = time / usual_gaps_[number];
    const double most_apart = 1 - model_.tuning().usual;
    return side_ == Pace::Side::kSlower ? gaps < (1 - most_apart) * usual
                                        : gaps > (1 + most_apart) * usual;
  }
  /// Says that so many gaps took so long [s].
  void describe(EventId id, std::uint32_t gaps, double time, Reason& reason) const;

 private:
  const Model& model_;
  Pace::Side side_;
  std::vector<ByBin> steps_;       // by number of the track
  std::vector<double> least_;      // limits [nat], the same
  std::vector<double> mean_gaps_;  // the same [ns]
  // The same: of slower the median, since who pauses has longer mean gaps while it comes.
  std::vector<double> usual_gaps_;
};

class PacesState : public ChannelState {
 public:
  explicit PacesState(const ExpectedPaces& expected);

  bool listens() const override { return !paces_.empty(); }
  void add(const Heard::Arrival& arrival, const Heard& /*heard*/) override {
    const std::uint32_t number = number_of_[arrival.id];
    if (number == kNoNumber || arrival.last == 0) {
      return;
    }
    OfType& pace = paces_[number];
    const std::int64_t gap = arrival.stamp - arrival.last_stamp;
    double step = expected_.step(number, gap);
    // Who loses messages on the way is not slow: Lost tells it. While a simulation stands still,
    // no time passes, and nothing has a pace.
    const bool counts = gap != 0 && !arrival.stalled && !arrival.attributes.isAfterLoss();
    if (pace.catchesUp(static_cast<double>(gap), step, expected_.meanGap(number)) || !counts) {
      step = 0;
    }
    pace.gaps = pace.sum.add(step, arrival.last_stamp) ? 1 : pace.gaps + 1;
    pace.last = arrival.stamp;
  }
  // The history of one event type has no phase that could be another one: its pace counts always.
  void disarm(EventId id) override { forget(id); }
  void forget(EventId id) override {
    if (number_of_[id] != kNoNumber) {
      paces_[number_of_[id]].sum.value = 0;
    }
  }
  void restart() override;
  void capAt(const std::vector<double>& limits) override;
  void closeWindow(const Heard& heard, std::vector<double>& evidence) override;
  std::optional<std::int64_t> onset(std::size_t track) const override {
    return paces_[expected_.numberOf(track)].sum.since;
  }
  void explain(std::size_t track, const Heard& /*heard*/, const RecentEvents& /*events*/,
               Suspect& suspect) const override {
    const OfType& pace = paces_[expected_.numberOf(track)];
    const double time = std::max(toSeconds(pace.last - pace.sum.since), kLeastTime);
    expected_.describe(suspect.id, pace.gaps, time, suspect.reason);
  }

 private:
  struct OfType {
    Sum sum;                 // since the begin of the first gap
    std::int64_t last = 0;   // end of the last one [ns]
    std::uint32_t gaps = 0;  // since the sum was 0
    double behind = 0;       // what gaps were too long, of which none was as usual since [ns]

    /// Whether a gap is short since its message waited, or the one before it did.
    bool catchesUp(double gap, double step, double mean_gap) {
      const bool catches_up = step > 0 && gap < mean_gap && behind > 0;
      const bool is_late = gap > kLateGap * mean_gap;
      behind = catches_up || is_late ? std::clamp(behind + gap - mean_gap, 0.0, kMostBehind) : 0;
      return catches_up;
    }
  };

  const ExpectedPaces& expected_;
  double most_of_limit_;
  std::vector<std::uint32_t> number_of_;  // of the track of a type, by id
  std::vector<OfType> paces_;             // by number of the track
};

ExpectedPaces::ExpectedPaces(const Model& model, std::vector<std::size_t> tracks, Pace::Side side)
    : Expectation(std::move(tracks)), model_(model), side_(side) {
  for (std::size_t number = 0; number < this->tracks().size(); ++number) {
    const EventId id = typeOf(number);
    const DelayHistogram gaps = model.learned().delays(id, id);
    steps_.push_back(stepsOf(gaps, side, model.tuning()));
    // What training does not tell, the gaps of now have to. What came in clumps told once.
    const Tuning& tuning = model.tuning();
    const bool is_told =
        toldBy(gaps, steps_.back()) >= tuning.least_told * model.learned().dispersion(id);
    least_.push_back(is_told ? tuning.least_sum : tuning.least_told);
    mean_gaps_.push_back(model.meanGap(id));
    usual_gaps_.push_back(side == Pace::Side::kSlower ? model.usualDelay(id, id, 0.5)
                                                      : model.meanGap(id));
  }
}

std::unique_ptr<ChannelState> ExpectedPaces::start() const {
  return std::make_unique<PacesState>(*this);
}

void ExpectedPaces::describe(EventId id, std::uint32_t gaps, double time, Reason& reason) const {
  const double usual = 1e9 * time / model_.meanGap(id);  // gaps in that time
  const double fewest = std::max(1e9 * time / model_.usualDelay(id, id, 0.95), usual / 2);
  const double most = std::min(1e9 * time / model_.usualDelay(id, id, 0.05), 2 * usual);
  // The more there are, the better their number is known.
  const double spread = std::max((most - fewest) / std::sqrt(std::max(usual, 1.0)) / 2, 0.5);
  const double least = std::max(std::floor(usual - spread), 0.0);
  const double largest = std::ceil(usual + spread);
  const double number = gaps;
  reason.kind = side_ == Pace::Side::kSlower ? Kind::kSlow : Kind::kFast;
  reason.unit = unit::kHertz;
  reason.lasted = time;
  reason.value = number / time;
  reason.usual = usual / time;
  reason.usual_shortest = least / time;
  reason.usual_longest = largest / time;
  char text[100];
  std::snprintf(text, sizeof text, "%u in the last %.1f s, usually %.0f to %.0f", gaps, time,
                least, largest);
  reason.words = text;
}

PacesState::PacesState(const ExpectedPaces& expected)
    : expected_(expected),
      most_of_limit_(expected.model().tuning().most_of_limit),
      number_of_(expected.model().size(), kNoNumber),
      paces_(expected.tracks().size()) {
  for (std::uint32_t number = 0; number < paces_.size(); ++number) {
    number_of_[expected.typeOf(number)] = number;
  }
}

void PacesState::restart() {
  for (OfType& pace : paces_) {
    pace.sum.value = 0;
    pace.behind = 0;
  }
}

void PacesState::capAt(const std::vector<double>& limits) {
  for (std::size_t number = 0; number < paces_.size(); ++number) {
    paces_[number].sum.capAt(limits[expected_.tracks()[number]], most_of_limit_);
  }
}

void PacesState::closeWindow(const Heard& /*heard*/, std::vector<double>& evidence) {
  for (std::size_t number = 0; number < paces_.size(); ++number) {
    const OfType& pace = paces_[number];
    const auto time = static_cast<double>(pace.last - pace.sum.since);
    const bool is_other = expected_.isOtherRate(number, pace.gaps, time);
    evidence[expected_.tracks()[number]] = is_other ? pace.sum.value : 0;
  }
}

}  // namespace

std::vector<Track> Pace::watch(const Choice& choice) const {
  std::vector<Track> tracks;
  for (EventId id = 0; id < choice.both.size(); ++id) {
    if (choice.isJudged(id)) {
      tracks.push_back({this, id, id});
    }
  }
  return tracks;
}

std::unique_ptr<const Expectation> Pace::expect(const Model& model, const Halves& /*halves*/,
                                                std::vector<std::size_t> tracks) const {
  return std::make_unique<ExpectedPaces>(model, std::move(tracks), side_);
}

}  // namespace self_awareness::core::evidence
