#include "self_awareness/core/model.h"

#include <stdexcept>
#include <utility>

namespace self_awareness::core {

Model::Model(DelayStatistics statistics) : statistics_(std::move(statistics)) {
  if (statistics_.events() == 0) {
    throw std::invalid_argument("a model needs at least one event");
  }
  const auto n = static_cast<Eigen::Index>(size());
  entropies_.resize(n, n);
  for (EventId to = 0; to < size(); ++to) {
    for (EventId from = 0; from < size(); ++from) {
      entropies_(from, to) = statistics_.pair(from, to).entropyBits();
    }
  }
}

double Model::probability(EventId from, EventId to, std::int64_t delay) const {
  const Histogram& histogram = statistics_.pair(from, to);
  if (histogram.empty()) {
    return 0;
  }
  return static_cast<double>(histogram.count(binning().bin(delay))) /
         static_cast<double>(histogram.total());
}

double Model::weight(EventId from, EventId to) const {
  const double sum = entropies_.col(to).sum();
  return sum > 0 ? 1 - entropies_(from, to) / sum : 1;
}

}  // namespace self_awareness::core
