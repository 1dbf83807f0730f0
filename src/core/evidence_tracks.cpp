#include "self_awareness/core/evidence_tracks.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "self_awareness/core/suspect.h"

namespace self_awareness::core {
namespace {

// By measurement (docs/evaluation): fewer predecessors find late answers later, more of them cost
// false alarms; with a smaller gain, timers that beat against each other get in.
constexpr std::size_t kPredecessors = 3;
constexpr double kLeastGain = 0.3;  // [nat]
constexpr std::uint64_t kFewestDelaysOfPair = 200;

// Few events in kRateSpan come in bursts, or when something happens.
constexpr double kLeastRate = 1.5;

constexpr std::size_t kAsked = 8;
constexpr std::uint64_t kFewestAnswers = 100;
constexpr double kMostMisses = 0.6;

/// Gains between all pairs, the mean of both directions.
class Gains {
 public:
  Gains(const EvidenceStatistics& first, const EvidenceStatistics& second,
        const EvidenceStatistics& both)
      : size_(both.size()), gains_(size_ * size_, 0) {
    add(first, second, both);
    add(second, first, both);
  }

  double operator()(EventId from, EventId to) const { return gains_[to * size_ + from]; }

 private:
  void add(const EvidenceStatistics& learned_from, const EvidenceStatistics& measured_on,
           const EvidenceStatistics& both) {
    const InformationGain gain(learned_from, measured_on);
    std::vector<std::optional<EventId>> there;
    for (const EventType& type : both.vocabulary().types()) {
      there.push_back(learned_from.vocabulary().find(type));
    }
    for (EventId to = 0; to < size_; ++to) {
      for (EventId from = 0; from < size_; ++from) {
        if (there[from] && there[to]) {
          gains_[to * size_ + from] += gain(*there[from], *there[to]) / 2;
        }
      }
    }
  }

  std::size_t size_;
  std::vector<double> gains_;
};

void addDelayTracks(const EvidenceStatistics& both, const Gains& gains,
                    std::vector<Track>& tracks) {
  for (EventId to = 0; to < both.size(); ++to) {
    std::vector<std::pair<double, EventId>> best;  // by negative gain
    for (EventId from = 0; from < both.size(); ++from) {
      if (gains(from, to) >= kLeastGain && both.pair(from, to).total() >= kFewestDelaysOfPair) {
        best.emplace_back(-gains(from, to), from);
      }
    }
    std::sort(best.begin(), best.end());
    for (std::size_t k = 0; k < std::min(best.size(), kPredecessors); ++k) {
      tracks.push_back({Channel::kDelay, to, best[k].second});
      tracks.push_back({Channel::kSlowDelay, to, best[k].second});
    }
  }
}

// Whoever follows `to` says nothing about it: a dead component's victims are silent, too.
void addAnswerTracks(const EvidenceStatistics& both, const Gains& gains,
                     std::vector<Track>& tracks) {
  for (EventId to = 0; to < both.size(); ++to) {
    std::vector<std::pair<double, EventId>> best;  // by the time that some misses take
    for (EventId from = 0; from < both.size(); ++from) {
      const EvidenceStatistics::Type& asking = both.type(from);
      if (from == to || asking.gaps < kFewestAnswers || both.type(to).gaps < kFewestAnswers ||
          gains(to, from) > gains(from, to) + kLeastGain) {
        continue;
      }
      const double misses = missRate(both, from, to);
      if (misses <= kMostMisses) {
        const double gap = static_cast<double>(asking.gap_sum) / static_cast<double>(asking.gaps);
        best.emplace_back(gap / (1 - misses), from);
      }
    }
    std::sort(best.begin(), best.end());
    for (std::size_t k = 0; k < std::min(best.size(), kAsked); ++k) {
      tracks.push_back({Channel::kAnswer, to, best[k].second});
    }
  }
}

}  // namespace

std::string channelName(Channel channel) {
  switch (channel) {
    case Channel::kOverdue:
      return "overdue";
    case Channel::kFewer:
    case Channel::kMore:
      return "rate";
    case Channel::kDelay:
    case Channel::kSlowDelay:
      return "pairs";
    case Channel::kAnswer:
      return "answers";
  }
  return "";
}

InformationGain::InformationGain(const EvidenceStatistics& learned_from,
                                 const EvidenceStatistics& measured_on)
    : learned_from_(learned_from), measured_on_(measured_on) {
  for (const EventType& type : learned_from.vocabulary().types()) {
    id_there_.push_back(measured_on.vocabulary().find(type));
  }
  any_.assign(learned_from.size(), std::vector<std::uint64_t>(log_bins::kBins, 0));
  for (EventId to = 0; to < learned_from.size(); ++to) {
    for (EventId from = 0; from < learned_from.size(); ++from) {
      const std::vector<std::uint32_t>& delays = learned_from.pair(from, to).delays;
      std::transform(delays.begin(), delays.end(), any_[from].begin(), any_[from].begin(),
                     std::plus<>());
    }
  }
}

double InformationGain::operator()(EventId from, EventId to) const {
  const std::vector<std::uint32_t>& learned = learned_from_.pair(from, to).delays;
  if (learned.empty() || !id_there_[from] || !id_there_[to]) {
    return 0;
  }
  const EvidenceStatistics::Pair& measured = measured_on_.pair(*id_there_[from], *id_there_[to]);
  if (measured.total() < kFewestDelays) {
    return 0;
  }
  const std::vector<double> of_pair = logProbabilities({learned.begin(), learned.end()});
  const std::vector<double> of_any = logProbabilities(any_[from]);
  double sum = 0;
  for (std::size_t bin = 0; bin < log_bins::kBins; ++bin) {
    sum += measured.delays[bin] * (of_pair[bin] - of_any[bin]);
  }
  return sum / static_cast<double>(measured.total());
}

std::vector<double> logProbabilities(const std::vector<std::uint64_t>& counts) {
  double total = static_cast<double>(counts.size());
  for (const std::uint64_t count : counts) {
    total += static_cast<double>(count);
  }
  std::vector<double> logs;
  logs.reserve(counts.size());
  for (const std::uint64_t count : counts) {
    logs.push_back(std::log((static_cast<double>(count) + 1) / total));
  }
  return logs;
}

std::vector<Track> chooseTracks(const EvidenceStatistics& first, const EvidenceStatistics& second,
                                const EvidenceStatistics& both) {
  std::vector<Track> tracks;
  for (EventId id = 0; id < both.size(); ++id) {
    if (both.type(id).gaps >= kFewestGaps) {
      tracks.push_back({Channel::kOverdue, id, id});
      if (static_cast<double>(both.type(id).rate_sum) >=
          kLeastRate * static_cast<double>(both.rateWindows())) {
        tracks.push_back({Channel::kFewer, id, id});
        tracks.push_back({Channel::kMore, id, id});
      }
    }
  }
  const Gains gains(first, second, both);
  addDelayTracks(both, gains, tracks);
  addAnswerTracks(both, gains, tracks);
  return tracks;
}

double missRate(const EvidenceStatistics& statistics, EventId from, EventId to) {
  const auto gaps = static_cast<double>(statistics.type(from).gaps);
  const auto answers = static_cast<double>(statistics.pair(from, to).answers);
  return (gaps - answers + 0.5) / (gaps + 1);
}

}  // namespace self_awareness::core
