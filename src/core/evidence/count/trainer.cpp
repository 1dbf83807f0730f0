#include "self_awareness/core/evidence/count/trainer.h"

#include <algorithm>
#include <utility>

#include "core/evidence/count/age_level.h"
#include "core/evidence/count/log_bins.h"
#include "core/evidence/count/repeats.h"
#include "self_awareness/core/stream/clock.h"
#include "self_awareness/core/stream/windows.h"

namespace self_awareness::core::evidence {
namespace {

// Events of a type whose delays are counted together.
constexpr std::size_t kTogether = 8;

}  // namespace

struct Trainer::OfMessages {
  AgeLevel level;
  Repeats repeats;
  // So far, of the recording: what others say must not matter, or counts would not add up.
  std::int64_t gap_sum = 0;  // [ns]
  std::int64_t gaps = 0;
};

Trainer::Trainer(Statistics& statistics, std::int64_t window)
    : statistics_(&statistics), window_(window), counts_(rateWindows(window)) {}

Trainer::~Trainer() = default;

void Trainer::startRecording(Start start) {
  endRecording();
  recording_.robot_start = start.robot_start;
  recording_.robot = std::move(start.robot);
  since_ = start.since;
  mode_ = {};
  stalls_ = std::move(start.stalls);
  next_stall_ = 0;
  next_event_ = 0;
}

void Trainer::onClockStep() {
  const std::int64_t robot_start = recording_.robot_start;
  std::string robot = recording_.robot;
  std::vector<EventId> latched;  // nobody sends it again
  for (EventId id = 0; id < recording_.firsts.size(); ++id) {
    if (recording_.firsts[id] >= 0 && statistics_->vocabulary().isLatched(id)) {
      latched.push_back(id);
    }
  }
  endRecording();
  recording_.robot_start = robot_start;
  recording_.robot = std::move(robot);
  resizeRecording();
  for (const EventId id : latched) {
    recording_.firsts[id] = 0;
  }
}

void Trainer::endRecording() {
  countWaiting();
  if (last_stamp_) {
    recording_.end = newest_stamp_;
    statistics_->addRecording(std::move(recording_));
  }
  recording_ = {};
  since_.reset();
  last_seen_.clear();
  mode_.restart();
  messages_.clear();
  last_stamp_.reset();
  number_ = 0;
  counts_.restart();
  stood_still_ = 0;
  waited_until_.reset();
}

void Trainer::resizeRecording() {
  recording_.events.resize(statistics_->size());
  recording_.longest_gaps.resize(statistics_->size());
  recording_.firsts.resize(statistics_->size(), -1);
}

void Trainer::addBefore(const Event& event) {
  noteFirst(event);
  if (statistics_->vocabulary().tellsMode(event.id)) {
    mode_.enter(event.id, event.stamp);
    mode_.restart();  // it has not lasted yet
  }
}

void Trainer::noteFirst(const Event& event) {
  resizeRecording();
  since_ = since_.value_or(event.stamp);
  std::int64_t& first = recording_.firsts.at(event.id);
  if (first < 0) {
    first = std::max<std::int64_t>(event.stamp - *since_, 0);
  }
}

void Trainer::add(const Event& event) {
  if (last_stamp_ && isClockStep(*last_stamp_, event.stamp)) {
    onClockStep();
  }
  resize();
  noteFirst(event);
  const std::int64_t stall = stallBeforeNext();
  const Event ran{event.stamp - stood_still_, event.id, event.attributes};
  if (last_stamp_) {
    closeWindows(ran.stamp);
    if (*last_stamp_ - recording_.start >= kSettled) {  // it has settled
      recording_.longest_silence =
          std::max(recording_.longest_silence, event.stamp - *last_stamp_ - stall);
    }
    recording_.longest_stall = std::max(recording_.longest_stall, stall);
    statistics_->addDuration(std::max<std::int64_t>(event.stamp - newest_stamp_, 0));
    newest_stamp_ = std::max(newest_stamp_, event.stamp);
  } else {
    newest_stamp_ = event.stamp;
    recording_.start = event.stamp;
    window_end_ = floorToGrid(ran.stamp, window_) + window_;
    mode_.begin(ran.stamp);
  }
  last_stamp_ = event.stamp;

  if (statistics_->vocabulary().tellsMode(ran.id)) {
    countTicks(ran.stamp - 1);  // a mode that ends now does not tick any more
    mode_.enter(ran.id, ran.stamp);
    countTicks(ran.stamp);
    return;
  }
  countTicks(ran.stamp);
  if (!statistics_->vocabulary().isMessage(ran.id)) {
    return;
  }
  counts_.add(ran.id);
  countAttributes(ran, event.stamp >= *since_ + recording_.firsts[ran.id] + kSettled);
  count(ran);
}

void Trainer::countTicks(std::int64_t now) {
  while (const std::optional<Event> tick = mode_.tickUntil(now)) {
    count(*tick);
  }
}

void Trainer::count(const Event& event) {
  Statistics::Type& type = statistics_->type(event.id);
  Seen& last = last_seen_.at(event.id);
  ++type.events;
  ++recording_.events[event.id];
  countDelays(event);
  if (last.number > 0) {
    const std::int64_t gap = std::max<std::int64_t>(event.stamp - last.stamp, 0);
    ++type.gaps;
    type.gap_sum += gap;
    type.addGap(gap);
    recording_.longest_gaps[event.id] = std::max(recording_.longest_gaps[event.id], gap);
  }
  last = Seen{event.stamp, ++number_};
}

std::int64_t Trainer::stallBeforeNext() {
  const bool stood_still =
      next_stall_ < stalls_.size() && stalls_[next_stall_].event == next_event_++;
  const std::int64_t length = stood_still ? stalls_[next_stall_++].length : 0;
  if (!last_stamp_ || length == 0) {
    return 0;
  }
  stood_still_ += length;
  waited_until_ = *last_stamp_ - stood_still_ + 2 * length;
  return length;
}

void Trainer::resize() {
  if (last_seen_.size() < statistics_->size()) {
    countWaiting();
    last_seen_.resize(statistics_->size());
    waiting_.resize(statistics_->size());
    counts_.resize(statistics_->size());
  }
}

void Trainer::countDelays(const Event& event) {
  const std::size_t types = last_seen_.size();
  const std::uint64_t last = last_seen_[event.id].number;
  Waiting& waiting = waiting_[event.id];
  waiting.came.resize(types);
  const std::size_t begin = waiting.bins.size();
  waiting.bins.resize(begin + types);
  for (EventId id = 0; id < types; ++id) {
    const Seen& other = last_seen_[id];
    waiting.bins[begin + id] =
        other.number > 0 ? static_cast<std::uint8_t>(log_bins::bin(event.stamp - other.stamp))
                         : Partners::kNotSeen;
    waiting.came[id] += last > 0 && other.number > last ? 1 : 0;
  }
  if (waiting.bins.size() == kTogether * types) {
    statistics_->count(event.id, waiting.bins, waiting.came);
    waiting.bins.clear();
    waiting.came.clear();
  }
}

void Trainer::countAttributes(const Event& event, bool started) {
  const Attributes& attributes = event.attributes;
  if (!attributes.isKnown()) {
    return;
  }
  if (event.id >= messages_.size()) {
    messages_.resize(statistics_->size());
  }
  OfMessages& messages = messages_[event.id];
  const std::int64_t mean_gap = messages.gaps > 0 ? messages.gap_sum / messages.gaps : 0;
  if (const Seen& last = last_seen_[event.id]; last.number > 0) {
    messages.gap_sum += std::max<std::int64_t>(event.stamp - last.stamp, 0);
    ++messages.gaps;
  }
  AttributeCounts& counts = statistics_->type(event.id).attributes;
  if (!started) {
    ++counts.steps[static_cast<std::size_t>(Attributes::Step::kNotKnown)];
    return;
  }
  ++counts.sizes[attributes.size];
  ++counts.steps[static_cast<std::size_t>(attributes.step)];
  counts.repeats += attributes.same ? 1 : 0;
  counts.longest_repeat =
      std::max(counts.longest_repeat, messages.repeats.add(event.stamp, attributes, mean_gap));
  if (attributes.age != Attributes::kNoAge) {
    ++counts.ages[attributes.age];
  }
  if (attributes.hasAge()) {
    const double rise = messages.level.add(event.stamp, ageOf(attributes.age));
    ++counts.rises[ageClass(toNanoseconds(rise))];
  }
}

void Trainer::countWaiting() {
  for (EventId id = 0; id < waiting_.size(); ++id) {
    if (!waiting_[id].bins.empty()) {
      statistics_->count(id, waiting_[id].bins, waiting_[id].came);
    }
  }
  waiting_.assign(waiting_.size(), {});
}

void Trainer::closeWindows(std::int64_t now) {
  for (; window_end_ <= now; window_end_ += window_) {
    counts_.close();
    if (waited_until_ && window_end_ - window_ < *waited_until_) {
      counts_.restart();  // what waited came at once
    }
    if (!counts_.full()) {
      continue;
    }
    statistics_->addRateWindows(1);
    for (EventId id = 0; id < counts_.counts().size(); ++id) {
      const std::uint64_t count = counts_.counts()[id];
      statistics_->type(id).rate_sum += count;
      statistics_->type(id).rate_squares += count * count;
    }
  }
}

}  // namespace self_awareness::core::evidence
