#include "self_awareness/core/paper/model.h"

#include <stdexcept>

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

}  // namespace self_awareness::core::paper
