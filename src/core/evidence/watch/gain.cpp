#include "core/evidence/watch/gain.h"

#include <cmath>

#include "core/evidence/count/log_bins.h"

namespace self_awareness::core::evidence {

InformationGain::InformationGain(const Statistics& learned_from, const Statistics& measured_on,
                                 double fewest_delays)
    : learned_from_(learned_from), measured_on_(measured_on), fewest_delays_(fewest_delays) {
  for (const EventType& type : learned_from.vocabulary().types()) {
    id_there_.push_back(measured_on.vocabulary().find(type));
  }
  for (const SumOfDelays& delays : learned_from.delaysToAny()) {
    any_.push_back(logProbabilities(delays));
  }
}

double InformationGain::operator()(EventId from, EventId to) const {
  if (!id_there_[from] || !id_there_[to]) {
    return 0;
  }
  const auto number = static_cast<double>(measured_on_.total(*id_there_[from], *id_there_[to]));
  if (number < fewest_delays_ || learned_from_.total(from, to) == 0) {
    return 0;
  }
  const DelayHistogram measured = measured_on_.delays(*id_there_[from], *id_there_[to]);
  const ByBin learned = learned_from_.delays(from, to).probabilities();
  double sum = 0;
  for (std::size_t bin = 0; bin < log_bins::kBins; ++bin) {
    if (measured[bin] > 0) {  // logarithms take most of the time
      sum += measured[bin] * (std::log(learned[bin]) - any_[from][bin]);
    }
  }
  return sum / number;
}

double InformationGain::most(EventId from, EventId to) const {
  if (!id_there_[from] || !id_there_[to]) {
    return 0;
  }
  const DelayHistogram measured = measured_on_.delays(*id_there_[from], *id_there_[to]);
  const auto number = static_cast<double>(measured.total());
  double sum = 0;
  for (std::size_t bin = 0; bin < log_bins::kBins; ++bin) {
    if (measured[bin] > 0) {
      sum += measured[bin] * (std::log(measured[bin] / number) - any_[from][bin]);
    }
  }
  return number > 0 ? sum / number : 0;
}

Gains::Gains(const std::array<const Statistics*, 2>& halves, double fewest_delays)
    : size_(halves[0]->size()), gains_(size_ * size_, 0) {
  add(*halves[0], *halves[1], fewest_delays);
  add(*halves[1], *halves[0], fewest_delays);
}

void Gains::add(const Statistics& learned_from, const Statistics& measured_on,
                double fewest_delays) {
  const InformationGain gain(learned_from, measured_on, fewest_delays);
  for (EventId to = 0; to < size_; ++to) {
    const Partners& partners = measured_on.partners(to);  // all others have no gain
    for (std::size_t k = 0; k < partners.size(); ++k) {
      const EventId from = partners.id(k);
      gains_[to * size_ + from] += gain(from, to) / 2;
    }
  }
}

}  // namespace self_awareness::core::evidence
