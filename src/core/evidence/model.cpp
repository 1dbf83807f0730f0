#include "self_awareness/core/evidence/model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

#include "core/evidence/bin_arrays.h"
#include "core/evidence/log_bins.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::evidence {
namespace {

// Share of the usual answers that a fault takes away: the fault that is looked for.
constexpr double kLost = 0.5;
constexpr double kLeastMissRate = 0.1;
constexpr double kMostMissRate = 0.95;

constexpr double kLeastMisses = 4;
constexpr double kLeastAnswerLimit = 5;  // [nat]

/// Mean and standard deviation of -log P of a pair's delays, learned from one half of the training
/// and measured on the other, both ways.
class HeldOutSurprise {
 public:
  explicit HeldOutSurprise(double least_deviation) : least_deviation_(least_deviation) {}

  void add(const Statistics::Delays& learned, const Statistics::Delays& measured) {
    if ((asArray(learned) == 0).all()) {
      return;
    }
    const LogProbabilities log_probabilities = logProbabilities(learned);
    const auto logs = asArray(log_probabilities);
    const auto counts = asArray(measured).cast<double>();
    count_ += counts.sum();
    sum_ -= (counts * logs).sum();
    squares_ += (counts * logs.square()).sum();
  }
  double mean() const { return count_ > 0 ? sum_ / count_ : 0; }
  double deviation() const {
    const double variance = count_ > 0 ? squares_ / count_ - mean() * mean() : 0;
    return std::max(std::sqrt(std::max(variance, 0.0)), least_deviation_);
  }

 private:
  double least_deviation_;  // delays that all fall into one bin vary by nothing
  double count_ = 0;
  double sum_ = 0;
  double squares_ = 0;
};

Statistics sum(const std::array<Statistics, 2>& halves) {
  Statistics both = halves[0];
  both.merge(halves[1]);
  return both;
}

double lowerEdge(std::size_t bin) {
  return static_cast<double>(log_bins::lowerEdge(bin));
}

double upperEdge(std::size_t bin) {
  return bin + 1 < log_bins::kBins ? lowerEdge(bin + 1) : std::numeric_limits<double>::infinity();
}

/// Whether all delays of a bin are harmless for one reason.
bool isHarmless(std::size_t bin, const Model::Harmless& harmless) {
  const auto lies = [&](double shift) {
    return lowerEdge(bin) + shift >= harmless.shortest &&
           upperEdge(bin) + shift <= harmless.longest;
  };
  // The bin that a period lies in is wide.
  const bool ends_period = lowerEdge(bin) < harmless.period && harmless.period <= upperEdge(bin);
  return lies(0) || (harmless.period > 0 && (lies(harmless.period) || lies(-harmless.period) ||
                                             (ends_period && harmless.shortest <= 0)));
}

}  // namespace

Model::Model(const Watched& watched, Learned learned)
    : statistics_(sum(watched.halves)), tracks_(watched.tracks), tuning_(watched.tuning) {
  if (size() == 0) {
    throw std::invalid_argument("a model needs at least one event");
  }
  checkTracks(tracks_, size());
  tuning_.validate();
  if (learned != Learned::kBoth) {
    half_ = watched.halves.at(learned == Learned::kFirst ? 0 : 1);
  }
  numberComponents();
  learnGaps();
  learnRates();
  learnDelays(watched.halves);
  learnAnswers();
}

void Model::numberComponents() {
  std::map<std::string, std::size_t> numbers;
  for (const EventType& type : vocabulary().types()) {
    const std::string& name = componentOf(type.source, type.scope);
    const auto [number, is_new] = numbers.emplace(name, components_.size());
    if (is_new) {
      components_.push_back(name);
    }
    component_of_.push_back(number->second);
  }
}

void Model::learnGaps() {
  gaps_.resize(size());
  for (EventId id = 0; id < size(); ++id) {
    const Statistics::Type& type = learned().type(id);
    if (type.gaps == 0) {
      continue;
    }
    Gaps& gaps = gaps_[id];
    gaps.longest = static_cast<double>(std::max<std::int64_t>(type.longest_gaps.front(), 1));
    const Statistics::Delays& counts = learned().delays(id, id);
    for (std::size_t bin = 0; bin < counts.size(); ++bin) {
      if (counts[bin] > 0) {
        const double middle = std::min(log_bins::middle(bin), gaps.longest);
        gaps.bins.push_back({middle, static_cast<double>(counts[bin]), middle * counts[bin]});
      }
    }
    for (std::size_t bin = gaps.bins.size(); bin-- > 1;) {
      gaps.bins[bin - 1].count += gaps.bins[bin].count;
      gaps.bins[bin - 1].sum += gaps.bins[bin].sum;
    }
  }
}

void Model::learnRates() {
  const auto windows = static_cast<double>(std::max<std::uint64_t>(learned().rateWindows(), 1));
  for (EventId id = 0; id < size(); ++id) {
    const Statistics::Type& type = learned().type(id);
    Rate rate;
    rate.mean = static_cast<double>(type.rate_sum) / windows;
    const double variance =
        static_cast<double>(type.rate_squares) / windows - rate.mean * rate.mean;
    const double drift = tuning_.least_rate_effect * rate.mean;
    rate.spread =
        std::sqrt(std::max(variance, 0.0) + std::min(1.0, rate.mean / 4) + 0.25 + drift * drift);
    rates_.push_back(rate);
  }
}

void Model::learnDelays(const std::array<Statistics, 2>& halves) {
  surprises_of_.resize(tracks_.size());
  for (std::size_t track = 0; track < tracks_.size(); ++track) {
    const auto& [channel, to, from] = tracks_[track];
    if (channel != Channel::kDelay) {
      continue;
    }
    HeldOutSurprise usual(tuning_.least_deviation);
    usual.add(halves[0].delays(from, to), halves[1].delays(from, to));
    usual.add(halves[1].delays(from, to), halves[0].delays(from, to));
    const LogProbabilities logs = logProbabilities(learned().delays(from, to));
    surprises_of_[track] = surprises_of_[track + 1] = surprises_.size();
    Surprises& surprises = surprises_.emplace_back();
    std::transform(logs.begin(), logs.end(), surprises.begin(), [&](double log) {
      return std::min((-log - usual.mean()) / usual.deviation(), tuning_.most_surprise);
    });
    const Harmless harmless = harmless_.emplace_back(learnHarmless(from, to));
    for (std::size_t bin = 0; bin < surprises.size(); ++bin) {
      if (isHarmless(bin, harmless)) {
        surprises[bin] = std::min(surprises[bin], 0.0);
      }
    }
  }
}

Model::Harmless Model::learnHarmless(EventId from, EventId to) const {
  const Statistics::Delays& delays = learned().delays(from, to);
  const auto total = static_cast<double>(learned().total(from, to));
  const Statistics::Type& asking = learned().type(from);
  const double period = static_cast<double>(asking.gap_sum) /
                        static_cast<double>(std::max<std::uint64_t>(asking.gaps, 1));
  const double effect =
      from == to ? tuning_.leastEffectOnGap(period) : tuning_.leastEffectOnDelay(period);
  Harmless harmless;
  harmless.period = from == to ? 0 : period;  // a gap does not wrap
  double below = 0;
  for (std::size_t bin = 0; bin < delays.size(); ++bin) {
    harmless.shortest =
        below <= (1 - tuning_.usual) / 2 * total ? lowerEdge(bin) : harmless.shortest;
    harmless.longest = below < (1 + tuning_.usual) / 2 * total ? upperEdge(bin) : harmless.longest;
    below += delays[bin];
  }
  harmless.shortest -= effect;
  harmless.longest += effect;
  return harmless;
}

double Model::surprise(std::size_t track, std::int64_t delay) const {
  const double surprise = surprises(track)[log_bins::bin(delay)];
  return surprise > kSurprising && harmless(track).contains(static_cast<double>(delay)) ? 0
                                                                                        : surprise;
}

void Model::learnAnswers() {
  steps_.resize(tracks_.size());
  for (std::size_t track = 0; track < tracks_.size(); ++track) {
    const auto& [channel, to, from] = tracks_[track];
    if (channel == Channel::kAnswer) {
      const double usual =
          std::clamp(evidence::missRate(learned().type(from).gaps, learned().answers(from, to)),
                     kLeastMissRate, kMostMissRate);
      const double faulty = usual + (1 - usual) * kLost;
      steps_[track] = {std::log((1 - faulty) / (1 - usual)), std::log(faulty / usual), usual,
                       std::llround(usualDelay(from, to, 0.5) * 1e9)};
    }
  }
}

double Model::overdue(EventId id, std::int64_t age) const {
  const Gaps& gaps = gaps_.at(id);
  if (gaps.bins.empty()) {
    return 0;
  }
  const auto a = static_cast<double>(std::max<std::int64_t>(age, 0));
  const double all = std::log(gaps.bins.front().sum + gaps.longest);
  const auto longer =
      std::upper_bound(gaps.bins.begin(), gaps.bins.end(), a,
                       [](double age, const Gaps::Bin& bin) { return age < bin.middle; });
  // If no gap was longer: exp(-a / b) would underflow long before its logarithm.
  return longer != gaps.bins.end() ? all - std::log(longer->sum - a * longer->count +
                                                    gaps.longest * std::exp(-a / gaps.longest))
                                   : all - std::log(gaps.longest) + a / gaps.longest;
}

double Model::logSurvival(EventId id, std::int64_t age) const {
  const Statistics::Type& type = learned().type(id);
  if (static_cast<double>(type.gaps) < tuning_.fewest_gaps) {
    return 0;
  }
  // The longest gaps are known exactly, the others by their bins.
  const std::vector<std::int64_t>& longest = type.longest_gaps;
  auto longer =
      static_cast<double>(std::partition_point(longest.begin(), longest.end(),
                                               [&](std::int64_t gap) { return gap > age; }) -
                          longest.begin());
  if (longer == static_cast<double>(longest.size())) {
    longer = 0;
    const Statistics::Delays& delays = learned().delays(id, id);
    for (std::size_t bin = log_bins::bin(age); bin < delays.size(); ++bin) {
      longer += delays[bin];
    }
  }
  const double tail =
      static_cast<double>(age) / static_cast<double>(std::max<std::int64_t>(longest.front(), 1));
  const double all = std::log(static_cast<double>(type.gaps) + 1);
  // If no gap was longer: exp(-tail) would underflow long before its logarithm.
  return longer > 0 ? std::log(longer + std::exp(-tail)) - all : -tail - all;
}

std::int64_t Model::longestGap(EventId id) const {
  const std::vector<std::int64_t>& longest = statistics_.type(id).longest_gaps;
  return longest.empty() ? 0 : longest.front();
}

std::int64_t Model::longestSilence() const {
  std::int64_t longest = 0;
  for (const Statistics::Recording& recording : statistics_.recordings()) {
    longest = std::max(longest, recording.longest_silence);
  }
  return longest;
}

bool Model::countsRequests(std::size_t track) const {
  const EventId from = tracks_[track].from;
  return usualDelay(from, from, 0.5) < tuning_.longest_gap_of_series;
}

double Model::meanGap(EventId id) const {
  const Statistics::Type& type = statistics_.type(id);
  return type.gaps == 0 ? 0 : static_cast<double>(type.gap_sum) / static_cast<double>(type.gaps);
}

double Model::usualDelay(EventId from, EventId to, double share) const {
  const Statistics::Delays& delays = learned().delays(from, to);
  const double wanted = share * static_cast<double>(learned().total(from, to));
  // How long the longest delay between two types was is not known: the last bin ends where it
  // begins.
  auto longest = static_cast<double>(log_bins::lowerEdge(log_bins::kBins - 1));
  if (from == to && learned().type(to).gaps > 0) {
    const Statistics::Type& type = learned().type(to);
    const auto longer = static_cast<std::size_t>(static_cast<double>(type.gaps) - wanted);
    if (longer < type.longest_gaps.size()) {
      return toSeconds(type.longest_gaps[longer]);
    }
    longest = static_cast<double>(type.longest_gaps.front());
  }
  double below = 0;
  for (std::size_t bin = 0; bin < delays.size(); ++bin) {
    if (delays[bin] > 0 && below + delays[bin] >= wanted) {
      const auto lower = static_cast<double>(log_bins::lowerEdge(bin));
      const double upper =
          bin + 1 < delays.size() ? static_cast<double>(log_bins::lowerEdge(bin + 1)) : longest;
      const double width = std::min(upper, std::max(longest, lower)) - lower;
      return (lower + width * (wanted - below) / delays[bin]) * 1e-9;
    }
    below += delays[bin];
  }
  return 0;
}

double Model::rate(EventId id, std::uint32_t count) const {
  return (count - rates_.at(id).mean) / rates_[id].spread;
}

double Model::leastLimit(std::size_t track) const {
  switch (tracks_.at(track).channel) {
    case Channel::kOverdue:
      return 0;
    case Channel::kFewer:
    case Channel::kMore:
      return tuning_.least_rate_limit;
    case Channel::kDelay:
    case Channel::kSlowDelay:
      // One late event makes two unusual delays, one too long and one too short: they must not do.
      return 2 * tuning_.most_surprise + 1;
    case Channel::kAnswer:
      return std::max(kLeastMisses * steps_[track].missed, kLeastAnswerLimit);
    case Channel::kDeadline:
      return countsRequests(track) ? tuning_.least_requests : tuning_.least_deadline;
  }
  return 0;
}

}  // namespace self_awareness::core::evidence
