#include "self_awareness/core/paper/model.h"

#include <cmath>
#include <stdexcept>

#include "core/paper/delay_table.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::paper {

Model::Model(const DelayStatistics& statistics)
    : vocabulary_(statistics.vocabulary()), binning_(statistics.binning()) {
  if (statistics.events() == 0) {
    throw std::invalid_argument("a model needs at least one event");
  }
  tables_.resize(vocabulary_.size());
  for (EventId to = 0; to < size(); ++to) {
    double entropy_sum = 0;
    for (EventId from = 0; from < size(); ++from) {
      tables_[to].append(statistics.pair(from, to).entries());
      entropy_sum += tables_[to].entropy(from);
    }
    entropy_sums_.push_back(entropy_sum);
    tables_[to].finish();
    gaps_.push_back(statistics.pair(to, to));
  }
}

Model::~Model() = default;

const DelayTable& Model::table(EventId to) const {
  return tables_[to];
}

double Model::entropy(EventId from, EventId to) const {
  return tables_.at(to).entropy(from);
}

double Model::probability(EventId from, EventId to, std::int64_t delay) const {
  return tables_.at(to).probability(from, binning_.bin(delay));
}

double Model::weight(EventId from, EventId to) const {
  return entropy_sums_.at(to) > 0 ? 1 - entropy(from, to) / entropy_sums_[to] : 1;
}

double Model::expectedScore(EventId to) const {
  const std::vector<double> probabilities = tables_.at(to).meanProbabilities();
  double score = 0;
  for (EventId from = 0; from < size(); ++from) {
    score += weight(from, to) * probabilities[from];
  }
  return score;
}

double Model::logSurvival(EventId id, std::int64_t age) const {
  const Histogram& gaps = gaps_.at(id);
  const std::uint64_t total = gaps.total();
  if (total < kFewestGaps) {
    return 0;
  }
  const std::int64_t bin = binning_.bin(age);
  std::uint64_t longer = 0;
  const Histogram::Entries entries = gaps.entries();
  for (auto entry = entries.rbegin(); entry != entries.rend() && entry->bin >= bin; ++entry) {
    longer += entry->count;
  }
  const double longest = static_cast<double>(gaps.quantile(1) + 1) * toSeconds(binning_.bin_size);
  const double tail = toSeconds(age) / longest;
  const double all = std::log(static_cast<double>(total) + 1);
  // If no gap was longer: exp(-tail) would underflow long before its logarithm.
  return longer == 0 ? -tail - all : std::log(static_cast<double>(longer) + std::exp(-tail)) - all;
}

}  // namespace self_awareness::core::paper
