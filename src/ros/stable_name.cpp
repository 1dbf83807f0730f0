#include "self_awareness/ros/stable_name.h"

#include <re2/re2.h>

namespace self_awareness::ros1 {

std::string stableName(const std::string& name) {
  // 19 digits are nanoseconds since 1970, 13 are milliseconds, in any year from 2001 to 2286.
  // Shorter numbers, such as a camera's serial number, belong to the name.
  static const re2::RE2 kAnonymous("_([0-9]{19}|[0-9]{1,7}_[0-9]{13,19})$");
  std::string stable = name;
  re2::RE2::Replace(&stable, kAnonymous, "");
  return stable;
}

}  // namespace self_awareness::ros1
