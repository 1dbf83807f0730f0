#include "clock_contest.h"

#include <algorithm>
#include <cmath>

#include "core/verdict/name_list.h"
#include "self_awareness/core/stream/clock_watch.h"
#include "self_awareness/core/stream/event.h"

namespace self_awareness {

// A replay may be faster than the robot was, but not by more.
constexpr double kFastest = 100;
constexpr std::size_t kMostRecent = 10;
constexpr std::size_t kMostPublishers = 5;

double ClockContest::pace() const {
  const auto passed =
      static_cast<double>(recent_.back().steady_time - recent_.front().steady_time);
  const auto advance = static_cast<double>(recent_.back().ros_time - recent_.front().ros_time);
  return passed > 0 ? std::clamp(advance / passed, 0.0, kFastest) : 1.0;
}

std::int64_t ClockContest::look(std::int64_t ros_now, std::int64_t steady_now, bool simulated) {
  const Look now{ros_now, steady_now};
  const bool set = simulated && last_ &&
                   core::wasSet(ros_now - last_->ros_time, steady_now - last_->steady_time, true);
  if (set) {
    set_at_ = steady_now;
    if (!since_ && publishers_.size() > 1) {
      pace_ = recent_.empty() ? 1.0 : pace();
      since_ = last_;
    }
    recent_.clear();
  }
  if (since_ && (!simulated || steady_now - set_at_ > kOverAfter)) {
    since_.reset();
  }
  if (recent_.empty() || steady_now - recent_.back().steady_time >= core::kNanosecondsPerSecond) {
    recent_.push_back(now);
    if (recent_.size() > kMostRecent) {
      recent_.pop_front();
    }
  }
  last_ = now;
  return timeOf(ros_now, steady_now);
}

std::int64_t ClockContest::timeOf(std::int64_t ros_time, std::int64_t steady_time) const {
  return since_ ? since_->ros_time +
                      std::llround(pace_ * static_cast<double>(steady_time - since_->steady_time))
                : ros_time;
}

std::string ClockContest::rivals() const {
  return publishers_.size() > 1
             ? core::listed({publishers_.begin(), publishers_.end()}, kMostPublishers)
             : "";
}

}  // namespace self_awareness
