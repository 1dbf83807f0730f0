#include "core/evidence/count/age_level.h"

#include <algorithm>

namespace self_awareness::core::evidence {

double AgeLevel::add(std::int64_t now, double age, double usual) {
  if (!begun_ || now - begin_ >= kSpan) {
    before_ = kNone;
    if (begun_ && now - begin_ < 2 * kSpan) {
      before_ = youngest_;
    }
    youngest_ = kNone;
    begin_ = now;
    begun_ = true;
  }
  const double known = std::min(youngest_, before_);
  if (age < std::min(usual, 0.0) && known < kNone && known - age > kAhead) {
    return known - age;  // it does not say what is usual, unless all are so
  }
  youngest_ = std::min(youngest_, age);
  return age - std::min(youngest_, before_);
}

}  // namespace self_awareness::core::evidence
