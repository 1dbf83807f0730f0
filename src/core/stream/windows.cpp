#include "self_awareness/core/stream/windows.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "self_awareness/core/stream/clock.h"

namespace self_awareness::core {

std::int64_t floorToGrid(std::int64_t stamp, std::int64_t length) {
  const std::int64_t remainder = stamp % length;
  return stamp - (remainder < 0 ? remainder + length : remainder);
}

std::size_t Window::unknown() const {
  return static_cast<std::size_t>(std::count_if(
      events.begin(), events.end(), [](const ObservedEvent& event) { return event.unknown; }));
}

Windows::Windows(std::int64_t length, WindowObserver& observer)
    : length_(length), observer_(observer) {
  if (length_ <= 0) {
    throw std::invalid_argument("window length must be more than 0 ns, it is " +
                                std::to_string(length_));
  }
}

bool Windows::add(const Event& event) {
  const bool clock_step = last_stamp_ && isClockStep(*last_stamp_, event.stamp);
  if (clock_step) {
    restart();
    observer_.onClockStep();
  }
  last_stamp_ = event.stamp;
  advance(event.stamp);
  const std::optional<ObservedEvent> observed = observer_.observe(event);
  if (!open_) {
    open_ = Window{floorToGrid(event.stamp, length_), {}};
    now_ = event.stamp;
  }
  if (observed) {
    open_->events.push_back(*observed);
  }
  return !clock_step;
}

void Windows::advance(std::int64_t now) {
  if (!open_) {
    return;
  }
  now_ = std::max(now_, now);
  while (open_->start + length_ <= now) {
    observer_.close(*open_, open_->start + length_);
    open_->start += length_;
    open_->events.clear();
  }
}

void Windows::finish() {
  if (open_) {
    observer_.close(*open_, std::min(open_->start + length_, now_));
  }
  restart();
}

void Windows::restart() {
  open_.reset();
  last_stamp_.reset();
}

}  // namespace self_awareness::core
