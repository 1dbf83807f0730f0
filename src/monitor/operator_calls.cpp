#include "operator_calls.h"

#include <ros/console.h>

#include <algorithm>

#include "ros/text.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/ros/encoding.h"

namespace self_awareness {
namespace {

std::string named(const std::string& caller) {
  return caller.empty() ? "somebody without a name" : ros1::printable(caller, ros1::kLongestName);
}

}  // namespace

bool OperatorCalls::admit(const std::string& service, const std::string& caller,
                          std::int64_t now) {
  Service& called = services_[service];
  called.calls = std::min<double>(
      kAtOnce, called.calls + static_cast<double>(now - called.counted_at) / kPause);
  called.counted_at = now;
  if (called.calls >= 1) {
    called.calls -= 1;
    ROS_INFO("~%s was called by %s", service.c_str(), named(caller).c_str());
    return true;
  }
  if (now >= called.refused_at + kPause) {
    called.refused_at = now;
    ROS_WARN("~%s is called too often, last by %s: %s", service.c_str(), named(caller).c_str(),
             refusal(service).c_str());
  }
  return false;
}

std::string OperatorCalls::refusal(const std::string& service) {
  return "too many calls: ~" + service + " is answered once in " +
         std::to_string(kPause / core::kNanosecondsPerSecond) + " s; all stays as it is";
}

void OperatorCalls::record(const std::string& service, const std::string& caller,
                           std::int64_t at) {
  on_record_ = "~" + service + " by " + named(caller) + " at " + ros1::utc(at);
}

}  // namespace self_awareness
