#include "self_awareness/ros/bag/event_log_packer.h"

#include <algorithm>
#include <utility>

#include "packed_events.h"
#include "self_awareness/ros/ros_time.h"

namespace self_awareness::ros1 {

void EventLogPacker::add(const core::Event& event, const core::Vocabulary& vocabulary) {
  // Events that roscpp's threads heard at once may be out of order by microseconds.
  if (events_.size() == kMostEvents || (!events_.empty() && event.stamp < events_.back().stamp)) {
    flush(events_.back().stamp);
  }
  advance(event.stamp);
  if (event.id >= ids_.size()) {
    ids_.resize(event.id + 1);
  }
  std::optional<core::EventId>& id = ids_[event.id];
  if (!id) {
    id = known_++;
    const core::EventType& type = vocabulary.at(event.id);
    self_awareness::EventType message;
    message.source = type.source;
    message.scope = type.scope;
    message.type = type.type;
    new_types_.push_back(message);
  }
  events_.push_back({event.stamp, *id, event.attributes});
}

void EventLogPacker::advance(std::int64_t now) {
  if (!begin_) {
    begin_ = now;
  } else if (now - *begin_ >= kLongestPart) {
    flush(now);
  }
}

void EventLogPacker::flush(std::int64_t now) {
  PackedEvents packed = PackedEvents::pack(events_);
  self_awareness::EventLog part;
  part.new_types = std::exchange(new_types_, {});
  part.heard_until = toRosTime(std::max(now, events_.empty() ? now : events_.back().stamp));
  part.dropped = dropped_;
  part.events = packed.events;
  part.first = toRosTime(packed.first);
  part.delay_bits = packed.delay_bits;
  part.id_bits = packed.id_bits;
  part.packed = std::move(packed.bytes);
  part.attributes = std::move(packed.attributes);
  for (const core::Waiting& waiting : waiting_) {
    part.waiting_from.push_back(waiting.from);
    part.waiting_to.push_back(waiting.to);
    part.waited.push_back(waiting.waited);
  }
  waiting_.clear();
  events_.clear();
  begin_ = now;
  handler_(std::move(part));
}

}  // namespace self_awareness::ros1
