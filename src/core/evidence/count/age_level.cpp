#include "core/evidence/count/age_level.h"

#include <algorithm>
#include <cmath>

#include "self_awareness/core/stream/attributes.h"
#include "self_awareness/core/stream/event.h"

namespace self_awareness::core::evidence {
namespace {

// Who is in the next class may be hardly older: a stamp in the future, too.
constexpr double kClassBack = Attributes::kAheadStep / (1 + Attributes::kAheadStep);
// What is remembered has to be longer than two classes: a stamp that stands still is ever older.
constexpr double kSpanOfAge = 2.2 * Attributes::kAgeStep;

}  // namespace

double AgeLevel::add(std::int64_t now, double age, const UsualAges& usual, double most) {
  const std::int64_t span = std::max(kSpan, toNanoseconds(kSpanOfAge * std::abs(age)));
  if (!begun_ || now - begin_ >= span) {
    const bool says_nothing = youngest_ == kNone && most < kNone;
    if (!begun_ || now - begin_ >= 2 * span) {
      before_ = kNone;
    } else if (!says_nothing) {
      before_ = youngest_;
    }
    youngest_ = kNone;
    begin_ = now;
    begun_ = true;
  }
  const double known = std::min(youngest_, before_);
  if (age < std::min(usual.youngest, 0.0) && known < kNone &&
      known - age > kAhead + Attributes::kAheadStep * std::abs(known)) {
    return known - age;
  }
  const double level = std::min(known, age);
  const double older = std::max(
      age - level - (level < 0 ? kClassBack : Attributes::kAgeStep) * std::abs(level), 0.0);
  if (older <= most || age <= usual.oldest) {
    youngest_ = std::min(youngest_, age);
  }
  return older;
}

}  // namespace self_awareness::core::evidence
