#include "self_awareness/core/stream/windows.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace self_awareness::core {

std::int64_t floorToGrid(std::int64_t stamp, std::int64_t length) {
  const std::int64_t remainder = stamp % length;
  return stamp - (remainder < 0 ? remainder + length : remainder);
}

std::optional<double> Window::score() const {
  if (events.empty()) {
    return std::nullopt;
  }
  double sum = 0;
  for (const ScoredEvent& event : events) {
    sum += event.score;
  }
  return sum / static_cast<double>(events.size());
}

std::size_t Window::unknown() const {
  return static_cast<std::size_t>(std::count_if(
      events.begin(), events.end(), [](const ScoredEvent& event) { return event.unknown; }));
}

Windows::Windows(std::int64_t length, Handler handler)
    : length_(length), handler_(std::move(handler)) {
  if (length_ <= 0) {
    throw std::invalid_argument("window length must be more than 0 ns, it is " +
                                std::to_string(length_));
  }
}

void Windows::add(const ScoredEvent& event) {
  advance(event.event.stamp);
  if (!open_) {
    open_ = Window{floorToGrid(event.event.stamp, length_), {}};
  }
  open_->events.push_back(event);
}

void Windows::advance(std::int64_t now) {
  while (open_ && open_->start + length_ <= now) {
    handler_(*open_);
    open_->start += length_;
    open_->events.clear();
  }
}

void Windows::finish() {
  if (open_) {
    handler_(*open_);
    open_.reset();
  }
}

}  // namespace self_awareness::core
