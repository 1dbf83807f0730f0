#include "self_awareness/core/evidence/count/statistics.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "core/evidence/count/bin_arrays.h"
#include "core/evidence/count/log_bins.h"
#include "self_awareness/core/stream/clock.h"
#include "self_awareness/core/stream/windows.h"

namespace self_awareness::core::evidence {
namespace {

using Partner = Statistics::Partner;
using Partners = Statistics::Partners;

constexpr DelayHistogram kNoDelays{};

bool lowerId(const Partner& partner, EventId id) {
  return partner.id < id;
}

template <typename Counts>
void addCounts(const Counts& counts, SumOfDelays& sum) {
  asArray(sum) += asArray(counts).template cast<std::uint64_t>();
}

// The years of a fleet may be more than a count holds: it then stays at the largest number.
void addCounts(const DelayHistogram& counts, DelayHistogram& sum) {
  asArray(sum) += asArray(counts).min(std::numeric_limits<std::uint32_t>::max() - asArray(sum));
}

const Partner* find(const Partners& partners, EventId id) {
  if (id < partners.size() && partners[id].id == id) {
    return &partners[id];  // if all event types are partners
  }
  const auto place = std::lower_bound(partners.begin(), partners.end(), id, lowerId);
  return place != partners.end() && place->id == id ? &*place : nullptr;
}

// Adds up counts by id; both are in order, and so is the result.
Partners sum(const Partners& a, const Partners& b) {
  Partners both;
  both.reserve(std::max(a.size(), b.size()));
  auto x = a.begin();
  auto y = b.begin();
  while (x != a.end() || y != b.end()) {
    if (y == b.end() || (x != a.end() && x->id < y->id)) {
      both.push_back(*x++);
    } else if (x == a.end() || y->id < x->id) {
      both.push_back(*y++);
    } else {
      both.push_back(*x++);
      both.back().answers += y->answers;
      addCounts(y->delays, both.back().delays);
      ++y;
    }
  }
  return both;
}

bool startsEarlier(const Statistics::Recording& a, const Statistics::Recording& b) {
  return std::tie(a.start, a.end) < std::tie(b.start, b.end);
}

// Types that a recording does not name have no events in it.
bool isSame(const Statistics::Recording& a, const Statistics::Recording& b, std::size_t types) {
  const auto at = [](const auto& counts, EventId id) {
    return id < counts.size() ? counts[id] : 0;
  };
  const auto first = [](const Statistics::Recording& recording, EventId id) {
    return id < recording.firsts.size() ? recording.firsts[id] : -1;
  };
  bool same = std::tie(a.start, a.end, a.longest_silence, a.robot_start) ==
              std::tie(b.start, b.end, b.longest_silence, b.robot_start);
  for (EventId id = 0; same && id < types; ++id) {
    same = at(a.events, id) == at(b.events, id) &&
           at(a.longest_gaps, id) == at(b.longest_gaps, id) && first(a, id) == first(b, id);
  }
  return same;
}

bool isEmpty(const Partner& partner) {
  return partner.answers == 0 && partner.delays == kNoDelays;
}

}  // namespace

std::size_t rateWindows(std::int64_t window) {
  if (window <= 0) {
    throw std::invalid_argument("window length must be more than 0 ns, it is " +
                                std::to_string(window));
  }
  return static_cast<std::size_t>(std::max<std::int64_t>(kRateSpan / window, 1));
}

void Statistics::Type::addGap(std::int64_t gap) {
  const auto place =
      std::lower_bound(longest_gaps.begin(), longest_gaps.end(), gap, std::greater<>());
  if (longest_gaps.size() < kLongestGaps || place != longest_gaps.end()) {
    longest_gaps.insert(place, gap);
    longest_gaps.resize(std::min(longest_gaps.size(), kLongestGaps));
  }
}

EventId Statistics::intern(const EventType& type) {
  const EventId id = vocabulary_.intern(type);
  if (id == types_.size()) {
    types_.emplace_back();
    partners_.emplace_back();
  }
  return id;
}

void Statistics::merge(const Statistics& other) {
  std::vector<EventId> here;
  here.reserve(other.size());
  for (const EventType& type : other.vocabulary_.types()) {
    here.push_back(intern(type));
  }
  for (EventId id = 0; id < here.size(); ++id) {
    const Type& theirs = other.types_[id];
    Type& ours = types_[here[id]];
    ours.events += theirs.events;
    ours.gaps += theirs.gaps;
    ours.gap_sum += theirs.gap_sum;
    ours.rate_sum += theirs.rate_sum;
    ours.rate_squares += theirs.rate_squares;
    addCounts(theirs.left_out, ours.left_out);
    for (const std::int64_t gap : theirs.longest_gaps) {
      ours.addGap(gap);
    }
    Partners partners = other.partners_[id];
    for (Partner& partner : partners) {
      partner.id = here[partner.id];
    }
    std::sort(partners.begin(), partners.end(),
              [](const Partner& a, const Partner& b) { return a.id < b.id; });
    partners_[here[id]] = sum(partners_[here[id]], partners);
  }
  for (const Recording& theirs : other.recordings_) {
    Recording ours{theirs.start,
                   theirs.end,
                   theirs.longest_silence,
                   std::vector<std::uint64_t>(size(), 0),
                   std::vector<std::int64_t>(size(), 0),
                   std::vector<std::int64_t>(size(), -1),
                   theirs.robot_start};
    for (EventId id = 0; id < theirs.events.size(); ++id) {
      ours.events[here[id]] = theirs.events[id];
      ours.longest_gaps[here[id]] = theirs.longest_gaps[id];
      ours.firsts[here[id]] = theirs.firsts[id];
    }
    addRecording(std::move(ours));
  }
  rate_windows_ += other.rate_windows_;
  duration_ += other.duration_;
}

void Statistics::addRecording(Recording recording) {
  // The same recording looks the same, whatever event types other ones had.
  std::size_t seen = recording.events.size();
  recording.firsts.resize(seen, -1);
  while (seen > 0 && recording.events[seen - 1] == 0 && recording.firsts[seen - 1] < 0) {
    --seen;
  }
  recording.events.resize(seen);
  recording.longest_gaps.resize(seen);
  recording.firsts.resize(seen);
  const auto place =
      std::upper_bound(recordings_.begin(), recordings_.end(), recording, startsEarlier);
  recordings_.insert(place, std::move(recording));
}

const DelayHistogram& Statistics::delays(EventId from, EventId to) const {
  const Partner* partner = find(partners_.at(to), from);
  return partner != nullptr ? partner->delays : kNoDelays;
}

std::uint64_t Statistics::answers(EventId from, EventId to) const {
  const Partner* partner = find(partners_.at(from), to);
  return partner != nullptr ? partner->answers : 0;
}

void Statistics::setPartners(EventId id, Partners partners) {
  const auto unordered =
      std::adjacent_find(partners.begin(), partners.end(),
                         [](const Partner& a, const Partner& b) { return a.id >= b.id; });
  if (unordered != partners.end() || (!partners.empty() && partners.back().id >= size())) {
    throw std::invalid_argument("partners of an event type must be event types, in order");
  }
  partners_.at(id) = std::move(partners);
}

Statistics::Partners& Statistics::allPartners(EventId id) {
  Partners& partners = partners_.at(id);
  if (partners.size() < size()) {
    Partners none(size());
    for (EventId other = 0; other < none.size(); ++other) {
      none[other].id = other;
    }
    partners = sum(partners, none);
  }
  return partners;
}

std::vector<SumOfDelays> Statistics::delaysToAny() const {
  std::vector<SumOfDelays> sums;
  sums.reserve(size());
  for (const Type& type : types_) {
    sums.push_back(type.left_out);
  }
  for (const Partners& partners : partners_) {
    for (const Partner& partner : partners) {
      addCounts(partner.delays, sums[partner.id]);
    }
  }
  return sums;
}

Statistics Statistics::withoutPairs() const {
  Statistics rest;
  rest.vocabulary_ = vocabulary_;
  rest.types_ = types_;
  for (Type& type : rest.types_) {
    type.left_out.fill(0);
  }
  rest.partners_.resize(size());
  rest.recordings_ = recordings_;
  rest.rate_windows_ = rate_windows_;
  rest.duration_ = duration_;
  return rest;
}

Statistics Statistics::only(const std::vector<Pair>& pairs) const {
  std::vector<std::vector<EventId>> kept(size());
  for (const Pair& pair : pairs) {
    kept.at(pair.to).push_back(pair.from);
    kept.at(pair.from).push_back(pair.to);
  }
  Statistics rest = withoutPairs();
  for (EventId id = 0; id < size(); ++id) {
    addCounts(types_[id].left_out, rest.types_[id].left_out);
    std::sort(kept[id].begin(), kept[id].end());
    for (const Partner& partner : partners_[id]) {
      if (std::binary_search(kept[id].begin(), kept[id].end(), partner.id)) {
        rest.partners_[id].push_back(partner);
      } else {
        addCounts(partner.delays, rest.types_[partner.id].left_out);
      }
    }
  }
  return rest;
}

bool operator==(const Statistics::Partner& a, const Statistics::Partner& b) {
  return a.id == b.id && a.answers == b.answers && a.delays == b.delays;
}

bool operator==(const Statistics& a, const Statistics& b) {
  if (a.vocabulary().types() != b.vocabulary().types() || a.rateWindows() != b.rateWindows() ||
      a.duration() != b.duration() ||
      !std::equal(a.recordings().begin(), a.recordings().end(), b.recordings().begin(),
                  b.recordings().end(),
                  [&](const auto& x, const auto& y) { return isSame(x, y, a.size()); })) {
    return false;
  }
  const auto counted = [](const Partners& partners) {
    Partners without_zeros;
    std::remove_copy_if(partners.begin(), partners.end(), std::back_inserter(without_zeros),
                        isEmpty);
    return without_zeros;
  };
  for (EventId id = 0; id < a.size(); ++id) {
    const Statistics::Type& x = a.type(id);
    const Statistics::Type& y = b.type(id);
    if (std::tie(x.events, x.gaps, x.gap_sum, x.longest_gaps, x.rate_sum, x.rate_squares,
                 x.left_out) != std::tie(y.events, y.gaps, y.gap_sum, y.longest_gaps, y.rate_sum,
                                         y.rate_squares, y.left_out) ||
        !(counted(a.partners(id)) == counted(b.partners(id)))) {
      return false;
    }
  }
  return true;
}

Trainer::Trainer(Statistics& statistics, std::int64_t window)
    : statistics_(&statistics), window_(window), counts_(0, rateWindows(window)) {}

void Trainer::startRecording(std::optional<std::int64_t> since, std::int64_t robot_start) {
  if (last_stamp_) {
    recording_.end = newest_stamp_;
    for (EventId id = 0; id < last_seen_.size(); ++id) {
      if (recording_.events[id] > 1) {
        std::int64_t& longest = recording_.longest_gaps[id];
        longest = std::max(longest, newest_stamp_ - kEnding - last_seen_[id].stamp);
      }
    }
    statistics_->addRecording(std::move(recording_));
  }
  recording_ = {};
  recording_.robot_start = robot_start;
  since_ = since;
  last_seen_.clear();
  last_stamp_.reset();
  number_ = 0;
  counts_.restart();
}

void Trainer::resizeRecording() {
  recording_.events.resize(statistics_->size());
  recording_.longest_gaps.resize(statistics_->size());
  recording_.firsts.resize(statistics_->size(), -1);
}

void Trainer::addBefore(const Event& event) {
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
  last_seen_.resize(statistics_->size());
  addBefore(event);
  counts_.resize(statistics_->size());
  if (last_stamp_) {
    closeWindows(event.stamp);
    recording_.longest_silence = std::max(recording_.longest_silence, event.stamp - *last_stamp_);
    statistics_->addDuration(std::max<std::int64_t>(event.stamp - newest_stamp_, 0));
    newest_stamp_ = std::max(newest_stamp_, event.stamp);
  } else {
    newest_stamp_ = event.stamp;
    recording_.start = event.stamp;
    window_end_ = floorToGrid(event.stamp, window_) + window_;
  }
  last_stamp_ = event.stamp;

  Statistics::Type& type = statistics_->type(event.id);
  Seen& last = last_seen_.at(event.id);
  ++type.events;
  ++recording_.events[event.id];
  counts_.add(event.id);
  Partner* partner = statistics_->allPartners(event.id).data();
  for (const Seen& other : last_seen_) {
    if (other.number > 0) {
      ++partner->delays[log_bins::bin(event.stamp - other.stamp)];
      partner->answers += last.number > 0 && other.number > last.number ? 1 : 0;
    }
    ++partner;
  }
  if (last.number > 0) {
    const std::int64_t gap = std::max<std::int64_t>(event.stamp - last.stamp, 0);
    ++type.gaps;
    type.gap_sum += gap;
    type.addGap(gap);
    recording_.longest_gaps[event.id] = std::max(recording_.longest_gaps[event.id], gap);
  }
  last = Seen{event.stamp, ++number_};
}

void Trainer::closeWindows(std::int64_t now) {
  for (; window_end_ <= now; window_end_ += window_) {
    counts_.close();
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
