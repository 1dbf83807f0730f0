#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "self_awareness/core/stream/recording_info.h"

namespace self_awareness::core::paper {

/// The threshold s* of eq. 5, and how it was found (docs/method.md, section 2.6).
struct Calibration {
  double threshold = 0;  ///< a window is abnormal if its score is less
  std::string method;    ///< "youden", "closest", or "fpr=RATE"
  /// Area under the ROC; NaN without faulty windows.
  double auc = std::numeric_limits<double>::quiet_NaN();
  double true_positive_rate = std::numeric_limits<double>::quiet_NaN();  ///< NaN like auc
  double false_positive_rate = 0;
  std::uint64_t normal_windows = 0;
  std::uint64_t faulty_windows = 0;
  double false_alarms_per_hour = 0;   ///< after persistence, on the normal recordings
  std::vector<RecordingInfo> normal;  ///< of normal operation, not trained on
  std::vector<RecordingInfo> faulty;
  std::vector<std::string> injected;  ///< faults that were made out of the normal recordings
  std::int64_t stamp = 0;             ///< when it was done [ns]; 0: not known
};

}  // namespace self_awareness::core::paper
