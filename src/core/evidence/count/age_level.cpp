#include "core/evidence/count/age_level.h"

#include <algorithm>
#include <cmath>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::core::evidence {
namespace {

// Ages come in classes (stream/attributes.h), old ones in wide ones. Who is in the next class may
// be hardly older: of an age, so much; and of a stamp in the future, to be older, or further
// ahead.
constexpr double kClass = 0.091;
constexpr double kClassBack = 0.16;
constexpr double kClassAhead = 0.19;
// What is remembered has to be longer than two classes: a stamp that stands still is ever older.
constexpr double kSpanOfAge = 0.2;

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
      known - age > kAhead + kClassAhead * std::abs(known)) {
    return known - age;
  }
  const double level = std::min(known, age);
  const double older =
      std::max(age - level - (level < 0 ? kClassBack : kClass) * std::abs(level), 0.0);
  if (older <= most || age <= usual.oldest) {
    youngest_ = std::min(youngest_, age);
  }
  return older;
}

}  // namespace self_awareness::core::evidence
