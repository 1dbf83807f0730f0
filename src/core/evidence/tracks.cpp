#include "self_awareness/core/evidence/tracks.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "core/evidence/bin_arrays.h"
#include "core/evidence/log_bins.h"
#include "core/evidence/relations.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::size_t kAsked = 8;
constexpr std::uint64_t kFewestGapsOfAnswers = 100;
constexpr double kMostMisses = 0.6;

using Halves = std::array<const Statistics*, 2>;

/// Gains of all pairs: the mean of learning from either half (docs/method.md, section 3.4).
class Gains {
 public:
  Gains(const Halves& halves, double fewest_delays)
      : size_(halves[0]->size()), gains_(size_ * size_, 0) {
    add(*halves[0], *halves[1], fewest_delays);
    add(*halves[1], *halves[0], fewest_delays);
  }

  double operator()(EventId from, EventId to) const { return gains_[to * size_ + from]; }

 private:
  void add(const Statistics& learned_from, const Statistics& measured_on, double fewest_delays) {
    const InformationGain gain(learned_from, measured_on, fewest_delays);
    for (EventId to = 0; to < size_; ++to) {
      for (EventId from = 0; from < size_; ++from) {
        gains_[to * size_ + from] += gain(from, to) / 2;
      }
    }
  }

  std::size_t size_;
  std::vector<double> gains_;
};

/// Chooses what to watch, by the counts of both halves.
class Choice {
 public:
  Choice(const Statistics& both, const Halves& halves, const SourceGraph& graph,
         const Tuning& tuning)
      : halves_(halves),
        tuning_(tuning),
        gains_(halves, tuning.fewest_delays),
        types_(both),
        relations_(both, graph, tuning) {}

  std::vector<Track> tracks() const {
    std::vector<Track> tracks;
    addTracksOfTypes(tracks);
    addDelayTracks(tracks);
    addAnswerTracks(tracks);
    addDeadlineTracks(tracks);
    tracks.erase(
        std::remove_if(tracks.begin(), tracks.end(),
                       [&](const Track& track) {
                         const bool own = track.channel == Channel::kDelay ||
                                          track.channel == Channel::kSlowDelay;
                         return !tuning_.isOn(channelName(track.channel)) ||
                                (own &&
                                 !tuning_.isOn(track.to == track.from ? "own gaps" : "relations"));
                       }),
        tracks.end());
    return tracks;
  }

 private:
  using Ranked = std::vector<std::pair<double, EventId>>;  // the least first
  using RankedPairs = std::vector<std::tuple<bool, double, EventId>>;

  void addTracksOfTypes(std::vector<Track>& tracks) const {
    for (EventId id = 0; id < types_.size(); ++id) {
      if (static_cast<double>(types_.type(id).gaps) >= tuning_.fewest_gaps) {
        tracks.push_back({Channel::kOverdue, id, id});
        if (static_cast<double>(types_.type(id).rate_sum) >=
            tuning_.least_rate * static_cast<double>(types_.rateWindows())) {
          tracks.push_back({Channel::kFewer, id, id});
          tracks.push_back({Channel::kMore, id, id});
        }
      }
    }
  }

  void addDelayTracks(std::vector<Track>& tracks) const {
    for (EventId to = 0; to < types_.size(); ++to) {
      RankedPairs best;  // first those that are watched, by negative gain
      for (EventId from = 0; from < types_.size(); ++from) {
        if (gains_(from, to) >= tuning_.least_gain &&
            static_cast<double>(halves_[0]->total(from, to) + halves_[1]->total(from, to)) >=
                tuning_.fewest_delays_of_pair) {
          best.emplace_back(!relations_.delays(from, to).watched, -gains_(from, to), from);
        }
      }
      keepBest(static_cast<std::size_t>(tuning_.predecessors), best);
      for (const auto& [waits, gain, from] : best) {
        tracks.push_back({Channel::kDelay, to, from});
        tracks.push_back({Channel::kSlowDelay, to, from});
      }
    }
  }

  // A type that follows `to` says nothing about it: the victims of a dead component are silent,
  // too.
  void addAnswerTracks(std::vector<Track>& tracks) const {
    for (EventId to = 0; to < types_.size(); ++to) {
      Ranked best;  // by the time that some misses take
      for (EventId from = 0; from < types_.size(); ++from) {
        const Statistics::Type& asking = types_.type(from);
        if (from == to || asking.gaps < kFewestGapsOfAnswers ||
            types_.type(to).gaps < kFewestGapsOfAnswers ||
            gains_(to, from) > gains_(from, to) + tuning_.least_gain) {
          continue;
        }
        const double misses =
            missRate(asking.gaps, halves_[0]->answers(from, to) + halves_[1]->answers(from, to));
        if (misses <= kMostMisses && relations_.answers(from, to).watched) {
          const double gap =
              static_cast<double>(asking.gap_sum) / static_cast<double>(asking.gaps);
          best.emplace_back(gap / (1 - misses), from);
        }
      }
      keepBest(kAsked, best);
      for (const auto& [time, from] : best) {
        tracks.push_back({Channel::kAnswer, to, from});
      }
    }
  }

  void addDeadlineTracks(std::vector<Track>& tracks) const {
    for (EventId to = 0; to < types_.size(); ++to) {
      Ranked best;  // by the share of the gaps without an answer
      for (EventId from = 0; from < types_.size(); ++from) {
        const std::uint64_t gaps = types_.type(from).gaps;
        const std::uint64_t answers = types_.answers(from, to);
        if (from != to && static_cast<double>(answers) >= tuning_.fewest_answers &&
            missRate(gaps, answers) <= tuning_.most_misses &&
            relations_.deadline(from, to).watched) {
          best.emplace_back(missRate(gaps, answers), from);
        }
      }
      keepBest(static_cast<std::size_t>(tuning_.deadlines), best);
      for (const auto& [misses, from] : best) {
        tracks.push_back({Channel::kDeadline, to, from});
      }
    }
  }

  template <typename Best>
  static void keepBest(std::size_t number, Best& best) {
    number = std::min(number, best.size());
    std::partial_sort(best.begin(), best.begin() + static_cast<std::ptrdiff_t>(number),
                      best.end());
    best.resize(number);
  }

  Halves halves_;
  const Tuning& tuning_;
  Gains gains_;
  const Statistics& types_;  // counts of both halves
  Relations relations_;
};

/// The counts of one half, with the event types of both and the same ids.
Statistics withTypes(const Statistics& first, const Statistics& second, const Statistics& counts) {
  Statistics all;
  for (const Statistics* half : {&first, &second}) {
    for (const EventType& type : half->vocabulary().types()) {
      all.intern(type);
    }
  }
  all.merge(counts);
  return all;
}

std::vector<Statistics::Pair> pairsOf(const std::vector<Track>& tracks, std::size_t types) {
  std::vector<Statistics::Pair> pairs;
  for (EventId id = 0; id < types; ++id) {
    pairs.push_back({id, id});  // the gaps between two of a type
  }
  for (const Track& track : tracks) {
    pairs.push_back({track.from, track.to});
  }
  return pairs;
}

template <typename Counts>
LogProbabilities logsOf(const Counts& counts) {
  const double total =
      static_cast<double>(counts.size()) + asArray(counts).template cast<double>().sum();
  LogProbabilities logs{};
  std::transform(counts.begin(), counts.end(), logs.begin(), [total](std::uint64_t count) {
    return std::log((static_cast<double>(count) + 1) / total);
  });
  return logs;
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
    case Channel::kDeadline:
      return "deadlines";
  }
  return "";
}

std::vector<std::string> channelNames() {
  return {"overdue", "rate", "pairs", "own gaps", "relations", "answers", "deadlines", "linker"};
}

InformationGain::InformationGain(const Statistics& learned_from, const Statistics& measured_on,
                                 double fewest_delays)
    : learned_from_(learned_from), measured_on_(measured_on), fewest_delays_(fewest_delays) {
  for (const EventType& type : learned_from.vocabulary().types()) {
    id_there_.push_back(measured_on.vocabulary().find(type));
  }
  for (const Statistics::SumOfDelays& delays : learned_from.delaysToAny()) {
    any_.push_back(logProbabilities(delays));
  }
}

double InformationGain::operator()(EventId from, EventId to) const {
  if (!id_there_[from] || !id_there_[to]) {
    return 0;
  }
  const Statistics::Delays& measured = measured_on_.delays(*id_there_[from], *id_there_[to]);
  const std::uint64_t number = asArray(measured).cast<std::uint64_t>().sum();
  const Statistics::Delays& learned = learned_from_.delays(from, to);
  const std::uint64_t learned_number = asArray(learned).cast<std::uint64_t>().sum();
  if (static_cast<double>(number) < fewest_delays_ || learned_number == 0) {
    return 0;
  }
  const double total = static_cast<double>(learned_number) + log_bins::kBins;
  double sum = 0;
  for (std::size_t bin = 0; bin < log_bins::kBins; ++bin) {
    if (measured[bin] > 0) {  // logarithms take most of the time
      sum += measured[bin] * (std::log((learned[bin] + 1.0) / total) - any_[from][bin]);
    }
  }
  return sum / static_cast<double>(number);
}

LogProbabilities logProbabilities(const Statistics::Delays& counts) {
  return logsOf(counts);
}

LogProbabilities logProbabilities(const Statistics::SumOfDelays& counts) {
  return logsOf(counts);
}

Watched watch(const Statistics& first, const Statistics& second, const SourceGraph& graph,
              const Tuning& tuning) {
  if (first.vocabulary().types() != second.vocabulary().types()) {
    return watch(withTypes(first, second, first), withTypes(first, second, second), graph, tuning);
  }
  const Halves halves{&first, &second};
  Watched watched;
  watched.tuning = tuning;
  Statistics both = first;
  both.merge(second);
  watched.tracks = Choice(both, halves, graph, tuning).tracks();
  const std::vector<Statistics::Pair> pairs = pairsOf(watched.tracks, first.size());
  watched.halves = {first.only(pairs), second.only(pairs)};
  return watched;
}

void checkTracks(const std::vector<Track>& tracks, std::size_t types) {
  for (std::size_t track = 0; track < tracks.size(); ++track) {
    const auto& [channel, to, from] = tracks[track];
    if (to >= types || from >= types) {
      throw std::invalid_argument("it watches an event type that it does not have");
    }
    const bool slow = channel == Channel::kSlowDelay;
    const std::size_t other = slow ? track - 1 : track + 1;
    if ((slow || channel == Channel::kDelay) &&
        (other >= tracks.size() || tracks[other].to != to || tracks[other].from != from ||
         tracks[other].channel != (slow ? Channel::kDelay : Channel::kSlowDelay))) {
      throw std::invalid_argument("it watches delays, but not both at present and for longer");
    }
  }
}

double missRate(std::uint64_t gaps, std::uint64_t answers) {
  const auto all = static_cast<double>(gaps);
  return (all - static_cast<double>(answers) + 0.5) / (all + 1);
}

}  // namespace self_awareness::core::evidence
