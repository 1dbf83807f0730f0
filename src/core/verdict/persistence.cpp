#include "self_awareness/core/verdict/persistence.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace self_awareness::core {

Persistence::Persistence(const Parameters& parameters) : parameters_(parameters) {
  const auto& [alarm_windows, alarm_of, hold_time] = parameters_;
  if (alarm_windows < 1 || alarm_windows > alarm_of) {
    throw std::invalid_argument("alarm_windows is " + std::to_string(alarm_windows) +
                                ", but must lie between 1 and alarm_of, which is " +
                                std::to_string(alarm_of));
  }
  if (hold_time < 0) {
    throw std::invalid_argument("hold_time must be 0 or more");
  }
}

bool Persistence::add(bool abnormal, std::int64_t end, bool certain) {
  recent_.push_back(abnormal);
  if (recent_.size() > static_cast<std::size_t>(parameters_.alarm_of)) {
    recent_.pop_front();
  }
  if (abnormal) {
    last_abnormal_ = end;
  }
  if (certain || std::count(recent_.begin(), recent_.end(), true) >= parameters_.alarm_windows) {
    raised_ = true;
  } else if (raised_ && end - last_abnormal_ >= parameters_.hold_time) {
    raised_ = false;
  }
  return raised_;
}

bool Persistence::leaveOut(std::int64_t length) {
  last_abnormal_ += length;
  return raised_;
}

void Persistence::raise(std::int64_t end) {
  raised_ = true;
  last_abnormal_ = end;
}

void Persistence::clear() {
  recent_.clear();
  raised_ = false;
}

}  // namespace self_awareness::core
