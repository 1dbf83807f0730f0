#include "processor_watch.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <utility>

#include "self_awareness/core/stream/event.h"

namespace self_awareness {
namespace {

constexpr std::int64_t kLongestStretch = core::kNanosecondsPerSecond;
constexpr std::int64_t kMuch = 25000000;  // that is told at once [ns]

/// Processor time that this thread has had [ns].
std::int64_t ownTime() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return time.tv_sec * core::kNanosecondsPerSecond + time.tv_nsec;
}

}  // namespace

ProcessorWatch::ProcessorWatch() : file_(open("/proc/pressure/cpu", O_RDONLY | O_CLOEXEC)) {}

ProcessorWatch::~ProcessorWatch() {
  if (file_ >= 0) {
    close(file_);
  }
}

std::int64_t ProcessorWatch::pressure() const {
  char text[256];
  const ssize_t length = file_ < 0 ? 0 : pread(file_, text, sizeof text - 1, 0);
  if (length <= 0) {
    return 0;
  }
  text[length] = '\0';
  // "some avg10=0.00 avg60=0.00 avg300=0.00 total=123" [us], and more lines
  const char* const total = std::strstr(text, "total=");
  return total == nullptr ? 0 : 1000 * std::strtoll(total + std::strlen("total="), nullptr, 10);
}

std::optional<core::Waiting> ProcessorWatch::look(std::int64_t now, std::int64_t steady_now,
                                                  std::int64_t pause) {
  const Moment moment{steady_now, pressure(), ownTime()};
  const Moment before = std::exchange(last_, moment);
  if (!stretch_ || now < stretch_->to) {
    stretch_ = core::Waiting{now, now, 0};
    return std::nullopt;
  }
  const std::int64_t passed = moment.steady - before.steady;
  const std::int64_t late = passed - pause - (moment.own - before.own);
  const std::int64_t waited =
      std::clamp<std::int64_t>(std::max(moment.pressure - before.pressure, late), 0, passed);
  // Simulated time may run at any pace.
  const auto of_time = static_cast<double>(now - stretch_->to);
  const std::int64_t waited_of_time =
      passed > 0
          ? std::llround(of_time * static_cast<double>(waited) / static_cast<double>(passed))
          : 0;
  if (waited_of_time > core::Waiting::kStoodStill) {
    // A standstill is a stretch of its own: what was before may be in no recording.
    stretch_ = core::Waiting{stretch_->to, stretch_->to, 0};
  }
  stretch_->waited += waited_of_time;
  stretch_->to = now;
  if (stretch_->waited < kMuch && stretch_->to - stretch_->from < kLongestStretch) {
    return std::nullopt;
  }
  return std::exchange(stretch_, core::Waiting{now, now, 0});
}

std::string loadInWords() {
  double load = 0;
  if (getloadavg(&load, 1) != 1) {
    return "";
  }
  const long cores = sysconf(_SC_NPROCESSORS_ONLN);
  char text[60];
  std::snprintf(text, sizeof text, "load %.1f on %ld core%s", load, cores, cores == 1 ? "" : "s");
  return text;
}

}  // namespace self_awareness
