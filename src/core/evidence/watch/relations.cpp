#include "core/evidence/watch/relations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/evidence/count/log_bins.h"
#include "core/evidence/watch/heads_and_tails.h"

namespace self_awareness::core::evidence {
namespace {

// So many lengths, each as probable, stand for the gaps beyond the last bin edge.
constexpr int kTailPoints = 8;

// /tf and /clock are for everybody, however many listen.
const std::set<std::string> kBroadcasts{"/tf", "/tf_static", "/clock"};

/// n log-likelihood ratios of shares that were observed and expected [nat].
double divergence(double n, double observed, double expected) {
  const auto term = [](double p, double q) { return p > 0 ? p * std::log(p / q) : 0; };
  return n * (term(observed, expected) + term(1 - observed, 1 - expected));
}

}  // namespace

Relations::Relations(const Statistics& counts, const SourceGraph& graph, const Tuning& tuning)
    : counts_(counts),
      graph_(graph),
      tuning_(tuning),
      broadcasts_(kBroadcasts),
      gaps_(counts.size()),
      cut_off_(counts.size(), 0) {
  double types = 0;
  for (EventId id = 0; id < counts.size(); ++id) {
    const Statistics::Type& type = counts.type(id);
    const bool is_judged =
        static_cast<double>(type.gaps) >= tuning.fewest_gaps && !counts.vocabulary().tellsMode(id);
    types += is_judged ? 1 : 0;
    cut_off_[id] = HeadsAndTails(counts, id, tuning).all();
    const DelayHistogram& delays = counts.delays(id, id);
    const auto longest = static_cast<double>(type.longestGap());
    for (std::size_t bin = 0; bin < delays.size(); ++bin) {
      if (delays[bin] > 0) {
        gaps_[id].push_back({std::min(log_bins::middle(bin), longest),
                             delays[bin] / static_cast<double>(type.gaps)});
      }
    }
    // The bin of the longest delays has no middle. Their sum is known, and they are taken to be
    // exponential: what happens seldom has short and long waits.
    if (delays.back() > 0) {
      double others = 0;
      for (const Gap& gap : gaps_[id]) {
        others += &gap == &gaps_[id].back() ? 0 : gap.length * gap.share;
      }
      Gap& last = gaps_[id].back();
      const double edge = last.length;
      const double beyond = std::max((meanGap(id) - others) / last.share - edge, 0.0);
      const double share = last.share / kTailPoints;
      gaps_[id].pop_back();
      double mean = 0;  // of the points below
      for (int point = 0; point < kTailPoints; ++point) {
        mean -= std::log1p(-(point + 0.5) / kTailPoints) / kTailPoints;
      }
      for (int point = 0; point < kTailPoints; ++point) {
        const double quantile = -std::log1p(-(point + 0.5) / kTailPoints) / mean;
        gaps_[id].push_back({edge + beyond * quantile, share});
      }
    }
  }
  looked_at_ = std::max(types * (types - 1), 1.0);
  std::map<std::string, std::set<std::string>> listeners;  // by topic
  std::set<std::string> all;
  for (const SourceGraph::Edge& edge : graph.edges()) {
    listeners[edge.topic].insert(edge.subscriber);
    all.insert(edge.subscriber);
  }
  for (const auto& [topic, subscribers] : listeners) {
    if (static_cast<double>(subscribers.size()) >= tuning.several &&
        2 * subscribers.size() > all.size()) {
      broadcasts_.insert(topic);
    }
  }
}

bool Relations::reaches(EventId from, EventId to) const {
  const EventType& asks = counts_.vocabulary().at(from);
  const EventType& answers = counts_.vocabulary().at(to);
  return asks.source == answers.source ? !asks.source.empty()
                                       : graph_.hears(answers.source, asks.source, asks.scope) &&
                                             broadcasts_.count(asks.scope) == 0;
}

bool Relations::isIrregular(EventId from, EventId to) const {
  // As little as the gaps can vary by their bins, against as much as the delays can.
  const auto range = [&](EventId first, EventId second, bool widest) {
    const DelayHistogram::Bins bins = counts_.delays(first, second).middle(0.9);
    const auto edge = [&](std::size_t bin) {
      return bin < log_bins::kBins ? static_cast<double>(log_bins::lowerEdge(bin))
                                   : std::numeric_limits<double>::infinity();
    };
    return widest ? edge(bins.last + 1) - edge(bins.first)
                  : std::max(edge(bins.last) - edge(bins.first + 1), 0.0);
  };
  const double delays = range(from, to, true);
  return std::min(range(from, from, false), range(to, to, false)) > delays;
}

double Relations::period(EventId from, EventId to) const {
  return std::min(meanGap(from), meanGap(to));
}

double Relations::medianDelay(EventId from, EventId to) const {
  return log_bins::middle(counts_.delays(from, to).middle(0).last);
}

bool Relations::isLate(EventId from, EventId to) const {
  return medianDelay(from, to) > period(from, to) / 2;
}

bool Relations::areOfOneSource(EventId from, EventId to) const {
  return counts_.vocabulary().at(from).source == counts_.vocabulary().at(to).source;
}

double Relations::spread(EventId from, EventId to, double left_out) const {
  const double period = this->period(from, to);
  const DelayHistogram& delays = counts_.delays(from, to);
  const double wanted = (1 - left_out) * static_cast<double>(counts_.total(from, to));
  if (wanted <= 0 || period <= 0) {
    return 1;
  }
  // Delays are phases: the last bin of a period is a neighbour of the first.
  struct Arc {
    double width = 0;  // [ns]
    double count = 0;
  };
  std::vector<Arc> arcs;
  for (std::size_t bin = 0; bin < delays.size(); ++bin) {
    const auto low = static_cast<double>(log_bins::lowerEdge(bin));
    if (low >= period) {
      break;
    }
    const double high =
        bin + 1 < delays.size() ? static_cast<double>(log_bins::lowerEdge(bin + 1)) : period;
    arcs.push_back({std::min(high, period) - low, static_cast<double>(delays[bin])});
  }
  double narrowest = period;
  double width = 0;
  double count = 0;
  std::size_t end = 0;  // the arc is [begin, end), around the circle
  for (std::size_t begin = 0; begin < arcs.size(); ++begin) {
    while (count < wanted && end < begin + arcs.size()) {
      width += arcs[end % arcs.size()].width;
      count += arcs[end % arcs.size()].count;
      ++end;
    }
    if (count >= wanted) {
      narrowest = std::min(narrowest, width);
    }
    width -= arcs[begin].width;
    count -= arcs[begin].count;
  }
  return narrowest / period;
}

Relation Relations::delays(EventId from, EventId to, const std::vector<Span>& more) const {
  Relation relation;
  if (from == to) {
    relation.watched = true;  // its own history needs no reason
    return relation;
  }
  std::vector<Span> spans = more;
  double least_share = 1;
  const auto total = static_cast<double>(counts_.type(to).events);
  for (const Statistics::Recording& recording : counts_.recordings()) {
    const auto events = [&](EventId id) {
      return id < recording.events.size() ? recording.events[id] : 0;
    };
    const double share = static_cast<double>(events(to)) / total;
    if (static_cast<double>(std::min(events(from), events(to))) >= tuning_.fewest_gaps) {
      least_share = std::min(least_share, share);
      spans.push_back({recording.start, recording.end, recording.robot_start, recording.robot});
    }
  }
  relation.starts = numberOfStarts(spans, toNanoseconds(tuning_.start_time));
  const double left_out = std::min(1 - tuning_.usual, least_share / 2);
  relation.spread = spread(from, to, left_out);
  relation.reaches = reaches(from, to);
  relation.irregular = isIrregular(from, to);
  const double level = relation.reaches && relation.irregular   ? 1
                       : relation.reaches || relation.irregular ? tuning_.chance
                                                                : tuning_.chance / looked_at_;
  const bool late = (!relation.reaches || areOfOneSource(from, to)) && isLate(from, to);
  relation.watched = !late && byChance(relation) <= level;
  relation.starts_needed =
      relation.watched || late || relation.spread >= 1
          ? 0
          : static_cast<std::size_t>(1 + std::ceil(std::log(level) / std::log(relation.spread)));
  return relation;
}

double Relations::missRateByChance(EventId from, EventId to) const {
  const double silent = cut_off_[to];
  const double time = static_cast<double>(counts_.type(to).gap_sum) + silent;  // [ns]
  if (time <= 0) {
    return 0;
  }
  double misses = 0;
  for (const Gap& asked : gaps_[from]) {
    for (const Gap& gap : gaps_[to]) {
      misses += asked.share * gap.share * std::max(gap.length - asked.length, 0.0);
    }
  }
  return std::min((misses * static_cast<double>(counts_.type(to).gaps) + silent) / time, 1.0);
}

Relations::Asked Relations::asked(EventId from, EventId to, std::uint64_t answers) const {
  Asked asked;
  const std::uint64_t gaps = counts_.type(from).gaps;
  const double misses = missRate(gaps, answers);
  const double by_chance = missRateByChance(from, to);
  asked.reaches = reaches(from, to);
  // Timers of one rate keep one phase, and so miss each other less often than by chance; who
  // pauses, or is asked, does not.
  const bool pauses = std::max(static_cast<double>(counts_.type(to).longestGap()), cut_off_[to]) >
                      tuning_.most_mean_gaps * meanGap(to);
  asked.beyond_chance =
      by_chance >= (pauses || asked.reaches ? tuning_.rare : tuning_.least_chance_misses) &&
      misses < by_chance;
  asked.divergence =
      asked.beyond_chance ? divergence(static_cast<double>(gaps), misses, by_chance) : 0;
  return asked;
}

Relation Relations::owed(EventId from, EventId to) const {
  const Asked asked = this->asked(from, to, counts_.answers(from, to));
  Relation relation;
  relation.reaches = asked.reaches;
  relation.irregular = asked.beyond_chance;
  // Two that answer to the same come one after the other, now in this order, now in that.
  const DelayHistogram::Bins usual = counts_.delays(from, to).middle(0.9);
  const bool in_order =
      log_bins::middle(usual.first) >= tuning_.least_of_longest * log_bins::middle(usual.last);
  const bool late = asked.reaches && areOfOneSource(from, to) && isLate(from, to);
  relation.watched = asked.beyond_chance && in_order && !late &&
                     (graph_.empty() || asked.reaches) &&
                     asked.divergence > std::log(looked_at_ / tuning_.chance);
  return relation;
}

bool Relations::mayBeOwed(EventId from, EventId to, std::uint64_t answers) const {
  if (missRate(counts_.type(from).gaps, answers) > tuning_.most_unusual) {
    return false;
  }
  const Asked asked = this->asked(from, to, answers);
  return asked.beyond_chance && asked.divergence > -std::log(tuning_.chance);
}

double byChance(const Relation& relation) {
  const std::size_t starts = std::max<std::size_t>(relation.starts, 1);
  return std::pow(relation.spread, static_cast<double>(starts - 1));
}

double missRate(std::uint64_t gaps, std::uint64_t answers) {
  const auto all = static_cast<double>(gaps);
  return (all - static_cast<double>(answers) + 0.5) / (all + 1);
}

}  // namespace self_awareness::core::evidence
