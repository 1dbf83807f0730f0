#include "self_awareness/ros/stable_name.h"

#include <re2/re2.h>

#include <cctype>

namespace self_awareness::ros1 {

std::string resolvedName(const std::string& name) {
  const auto first = static_cast<unsigned char>(name.empty() ? '~' : name.front());
  if (first != '/' && first != '_' && std::isalnum(first) == 0) {
    return name;
  }
  std::string whole = "/";
  for (const char c : name) {
    if (c != '/' || whole.back() != '/') {
      whole += c;
    }
  }
  if (whole.size() > 1 && whole.back() == '/') {
    whole.pop_back();
  }
  return whole;
}

std::string stableName(const std::string& name) {
  // 19 digits are nanoseconds since 1970, 13 are milliseconds, in any year from 2001 to 2286.
  // Shorter numbers, such as a camera's serial number, belong to the name.
  static const re2::RE2 kAnonymous("_([0-9]{19}|[0-9]{1,7}_[0-9]{13,19})$");
  // A player (`rosbag play`) is anonymous, however short the number is that its name ends in.
  static const re2::RE2 kPlayer("(^|/)play_[0-9]+$");
  std::string stable = resolvedName(name);
  re2::RE2::Replace(&stable, kAnonymous, "");
  re2::RE2::Replace(&stable, kPlayer, "\\1play");
  return stable;
}

}  // namespace self_awareness::ros1
