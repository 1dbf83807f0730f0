#include "core/evidence/limits/left_out.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "self_awareness/core/evidence/limits/limits.h"

namespace self_awareness::core::evidence {

LeftOut::LeftOut(const std::vector<Part>& parts) : parts_(parts), exceeded_(parts.size(), false) {
  double all = 0;
  std::map<std::size_t, double> of_sample;
  for (const Part& part : parts_) {
    all += part.hours;
    of_sample[part.sample] += part.hours;
  }
  for (const Part& part : parts_) {
    left_out_by_.push_back(of_sample[part.sample] <= all / 2 ? By::kSample
                           : part.hours <= all / 2           ? By::kPart
                                                             : By::kNothing);
  }
}

void LeftOut::Others::add(double value, std::size_t its_group) {
  if (value > largest) {
    second = its_group == group ? second : largest;
    largest = value;
    group = its_group;
  } else if (its_group != group) {
    second = std::max(second, value);
  }
}

void LeftOut::add(const std::vector<double>& largest, const std::vector<double>& agreed,
                  double least, double margin) {
  Others by_sample;
  Others by_part;
  for (std::size_t part = 0; part < parts_.size(); ++part) {
    by_sample.add(agreed[part], parts_[part].sample);
    by_part.add(agreed[part], part);
  }
  for (std::size_t part = 0; part < parts_.size(); ++part) {
    if (left_out_by_[part] == By::kNothing) {
      continue;
    }
    const double others = left_out_by_[part] == By::kSample
                              ? by_sample.without(parts_[part].sample)
                              : by_part.without(part);
    const double limit = std::max(least, margin * others);
    // Where the others know nothing of it, there would be no limit.
    exceeded_[part] = exceeded_[part] || (limit > 0 && largest[part] > limit);
  }
}

std::size_t LeftOut::exceeded() const {
  return static_cast<std::size_t>(std::count(exceeded_.begin(), exceeded_.end(), true));
}

double LeftOut::hours() const {
  double all = 0;
  double judged = 0;
  for (std::size_t part = 0; part < parts_.size(); ++part) {
    all += parts_[part].hours;
    judged += left_out_by_[part] == By::kNothing ? 0 : parts_[part].hours;
  }
  return judged > 0 ? judged : all;
}

double highestRate(std::size_t exceeded, double hours) {
  // The rates of robots are taken for gamma distributed: few alarms on most, many on some. The
  // posterior is one, too; this is its quantile.
  constexpr double kQuietest = 0.58;  // of the shape that was learned from robots, 0.1
  constexpr double kRaised = 0.5;  // alarms of one exceeded limit: persistence leaves out others
  constexpr double kQuantile = 1.6449;  // of the normal distribution, 95 %
  const double shape = kRaised * static_cast<double>(exceeded);
  // Wilson and Hilferty's quantile of the gamma distribution, 3 % too low at most from 1/2 on.
  const double alarms =
      exceeded == 0
          ? kQuietest
          : shape * std::pow(1 - 1 / (9 * shape) + kQuantile / (3 * std::sqrt(shape)), 3);
  return alarms / (LimitFinder::kHoursOfRobots + hours);
}

}  // namespace self_awareness::core::evidence
