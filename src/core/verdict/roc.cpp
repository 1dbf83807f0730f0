#include "self_awareness/core/verdict/roc.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>

namespace self_awareness::core {
namespace {

void sortFinite(std::vector<double>& scores) {
  if (!std::all_of(scores.begin(), scores.end(), [](double s) { return std::isfinite(s); })) {
    throw std::invalid_argument("a ROC needs finite scores");
  }
  std::sort(scores.begin(), scores.end());
}

std::size_t countBelow(const std::vector<double>& sorted, double cutoff) {
  return static_cast<std::size_t>(
      std::distance(sorted.begin(), std::lower_bound(sorted.begin(), sorted.end(), cutoff)));
}

std::size_t countUpTo(const std::vector<double>& sorted, double cutoff) {
  return static_cast<std::size_t>(
      std::distance(sorted.begin(), std::upper_bound(sorted.begin(), sorted.end(), cutoff)));
}

double rateBelow(const std::vector<double>& sorted, double cutoff) {
  return sorted.empty() ? std::numeric_limits<double>::quiet_NaN()
                        : static_cast<double>(countBelow(sorted, cutoff)) /
                              static_cast<double>(sorted.size());
}

double areaUnderCurve(const std::vector<double>& normal, const std::vector<double>& abnormal) {
  double wins = 0;
  for (const double score : normal) {
    const std::size_t below = countBelow(abnormal, score);
    const std::size_t ties = countUpTo(abnormal, score) - below;
    wins += static_cast<double>(below) + static_cast<double>(ties) / 2;
  }
  return wins / (static_cast<double>(normal.size()) * static_cast<double>(abnormal.size()));
}

}  // namespace

Roc::Roc(std::vector<double> normal, std::vector<double> abnormal)
    : normal_(std::move(normal)), abnormal_(std::move(abnormal)) {
  if (normal_.empty()) {
    throw std::invalid_argument("a ROC needs scores of normal operation");
  }
  sortFinite(normal_);
  sortFinite(abnormal_);
  auc_ = areaUnderCurve(normal_, abnormal_);

  std::vector<double> scores;
  std::merge(normal_.begin(), normal_.end(), abnormal_.begin(), abnormal_.end(),
             std::back_inserter(scores));
  scores.erase(std::unique(scores.begin(), scores.end()), scores.end());
  points_.push_back(at(-std::numeric_limits<double>::infinity()));
  for (std::size_t i = 1; i < scores.size(); ++i) {
    points_.push_back(at(scores[i - 1] + (scores[i] - scores[i - 1]) / 2));
  }
  points_.push_back(at(std::numeric_limits<double>::infinity()));
}

Roc::Point Roc::at(double cutoff) const {
  return Point{cutoff, rateBelow(abnormal_, cutoff), rateBelow(normal_, cutoff)};
}

Roc::Point Roc::youden() const {
  if (abnormal_.empty()) {
    throw std::logic_error("Youden's J needs scores of abnormal windows");
  }
  const auto normal = static_cast<double>(normal_.size());
  const auto abnormal = static_cast<double>(abnormal_.size());
  // Products of counts are exact: the difference of two rates would make or break ties by
  // rounding.
  const auto youdens_j = [&](const Point& point) {
    return std::round(point.true_positive_rate * abnormal) * normal -
           std::round(point.false_positive_rate * normal) * abnormal;
  };
  return *std::max_element(points_.begin(), points_.end(), [&](const Point& a, const Point& b) {
    return youdens_j(a) < youdens_j(b);
  });
}

Roc::Point Roc::closest() const {
  if (abnormal_.empty()) {
    throw std::logic_error("the distance to (0, 1) needs scores of abnormal windows");
  }
  const auto normal = static_cast<double>(normal_.size());
  const auto abnormal = static_cast<double>(abnormal_.size());
  const auto squared_distance = [&](const Point& point) {
    const double missed = std::round((1 - point.true_positive_rate) * abnormal) * normal;
    const double false_alarms = std::round(point.false_positive_rate * normal) * abnormal;
    return missed * missed + false_alarms * false_alarms;
  };
  return *std::min_element(points_.begin(), points_.end(), [&](const Point& a, const Point& b) {
    return squared_distance(a) < squared_distance(b);
  });
}

Roc::Point Roc::level(double false_positive_rate) const {
  if (!(false_positive_rate >= 0 && false_positive_rate <= 1)) {
    throw std::invalid_argument("a false positive rate lies between 0 and 1");
  }
  const auto above = std::find_if(points_.begin(), points_.end(), [&](const Point& point) {
    return point.false_positive_rate > false_positive_rate;
  });
  const Point& point = *std::prev(above);  // the first, -infinity, has the rate 0
  return std::isinf(point.cutoff) && point.cutoff < 0 ? at(normal_.front()) : point;
}

}  // namespace self_awareness::core
