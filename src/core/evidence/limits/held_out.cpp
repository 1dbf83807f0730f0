#include "core/evidence/limits/held_out.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace self_awareness::core::evidence {
HeldOut::HeldOut(const std::vector<Part>& parts, double scale, const Tuning& tuning)
    : prior_scale_(scale), tuning_(tuning) {
  std::vector<std::size_t> by_sample;
  std::vector<std::size_t> by_part;
  for (const Part& part : parts) {
    by_part.push_back(by_part.size());
    by_sample.push_back(part.sample);
  }
  levels_.push_back(levelOf(parts, std::move(by_sample)));
  levels_.push_back(levelOf(parts, std::move(by_part)));
}

HeldOut::Level HeldOut::levelOf(const std::vector<Part>& parts,
                                std::vector<std::size_t> group_of) {
  Level level;
  double all = 0;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    level.hours.resize(std::max(level.hours.size(), group_of[part] + 1), 0);
    level.hours[group_of[part]] += parts[part].hours;
    all += parts[part].hours;
  }
  // What is shorter than what it is left out of: else the others say too little about it.
  for (double& hours : level.hours) {
    hours = hours <= all / 2 ? hours : 0;
    level.eligible_hours += hours;
  }
  level.group_of = std::move(group_of);
  return level;
}

double HeldOut::exceedance(const Level& level, const std::vector<double>& largest,
                           double least) const {
  std::vector<double> of_group(level.hours.size(), 0);
  for (std::size_t part = 0; part < largest.size(); ++part) {
    double& group = of_group[level.group_of[part]];
    group = std::max(group, largest[part]);
  }
  const auto first = std::max_element(of_group.begin(), of_group.end());
  if (first == of_group.end() || *first <= least ||
      level.hours[static_cast<std::size_t>(first - of_group.begin())] <= 0) {
    return 0;
  }
  const double most = *first;
  *first = 0;
  const double second = std::max(*std::max_element(of_group.begin(), of_group.end()),
                                 tuning_.share_of_least * least);
  if (second <= 0) {
    return 0;  // the others know nothing of it
  }
  return std::log(most / second);
}

double HeldOut::scale(const Level& level) const {
  return (level.logarithms + prior_scale_ * tuning_.prior_exceedances) /
         (level.exceedances + tuning_.prior_exceedances);
}

void HeldOut::add(const std::vector<double>& largest, double least) {
  for (Level& level : levels_) {
    const double logarithm = exceedance(level, largest, least);
    if (logarithm > std::log(tuning_.least_excess)) {
      level.exceedances += 1;
      level.logarithms += logarithm - std::log(tuning_.least_excess);
    }
  }
}

double HeldOut::margin(double rate) const {
  double margin = 1;
  for (const Level& level : levels_) {
    if (level.eligible_hours > 0) {
      // What was not seen yet may come: half an exceedance stands for it.
      const double expected = std::max(level.exceedances, 0.5) / (level.eligible_hours * rate);
      margin = std::max(margin, std::exp(std::log(tuning_.least_excess) +
                                         scale(level) * std::max(std::log(expected), 0.0)));
    }
  }
  return margin;
}

double HeldOut::excess(const std::vector<double>& largest, double least) const {
  return std::exp(exceedance(levels_.front(), largest, least));
}

}  // namespace self_awareness::core::evidence
