#pragma once

#include <vector>

namespace self_awareness::core {

/// Receiver operating characteristic of "abnormal if score < cut-off" (paper, section III-D, eq.
/// 5; docs/method.md, section 2.6). Candidate cut-offs are the midpoints between neighbouring
/// distinct scores, and +-infinity.
class Roc {
 public:
  /// What a cut-off does.
  struct Point {
    double cutoff = 0;               ///< scores below it are abnormal
    double true_positive_rate = 0;   ///< abnormal windows found, 0 to 1
    double false_positive_rate = 0;  ///< normal windows called abnormal, 0 to 1
  };

  /// @param normal scores of normal windows, at least one
  /// @param abnormal scores of abnormal windows; without any, youden() and closest() are not
  /// defined, and auc() and the true positive rates are NaN
  /// @throw std::invalid_argument if there is no normal score, or a score is not finite
  Roc(std::vector<double> normal, std::vector<double> abnormal);

  /// All candidates, from -infinity to +infinity.
  const std::vector<Point>& points() const { return points_; }
  /// P(abnormal < normal) + P(tie) / 2 for two windows drawn at random, 0 to 1.
  double auc() const { return auc_; }

  /// The cut-off that maximises Youden's J = TPR - FPR; the smallest of several.
  /// @throw std::logic_error if there are no abnormal scores.
  Point youden() const;
  /// The cut-off closest to (0, 1) in the plot; the smallest of several.
  /// @throw std::logic_error if there are no abnormal scores.
  Point closest() const;
  /// The largest cut-off with at most the given false positive rate (0 to 1). If only -infinity
  /// has so few, the lowest normal score: no normal one lies below it.
  Point level(double false_positive_rate) const;
  /// The rates at any cut-off.
  Point at(double cutoff) const;

 private:
  std::vector<double> normal_;    // sorted
  std::vector<double> abnormal_;  // sorted
  std::vector<Point> points_;
  double auc_ = 0;
};

}  // namespace self_awareness::core
