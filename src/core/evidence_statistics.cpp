#include "self_awareness/core/evidence_statistics.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <string>
#include <tuple>

#include "self_awareness/core/clock.h"
#include "self_awareness/core/windows.h"

namespace self_awareness::core {
namespace {

void addDelays(const std::vector<std::uint32_t>& from, std::vector<std::uint32_t>& to) {
  if (from.empty()) {
    return;
  }
  to.resize(log_bins::kBins, 0);
  std::transform(from.begin(), from.end(), to.begin(), to.begin(), std::plus<>());
}

}  // namespace

std::size_t rateWindows(std::int64_t window) {
  if (window <= 0) {
    throw std::invalid_argument("window length must be more than 0 ns, it is " +
                                std::to_string(window));
  }
  return static_cast<std::size_t>(std::max<std::int64_t>(kRateSpan / window, 1));
}

void EvidenceStatistics::Type::addGap(std::int64_t gap) {
  const auto place =
      std::lower_bound(longest_gaps.begin(), longest_gaps.end(), gap, std::greater<>());
  if (longest_gaps.size() < kLongestGaps || place != longest_gaps.end()) {
    longest_gaps.insert(place, gap);
    longest_gaps.resize(std::min(longest_gaps.size(), kLongestGaps));
  }
}

std::uint64_t EvidenceStatistics::Pair::total() const {
  return std::accumulate(delays.begin(), delays.end(), std::uint64_t{0});
}

EventId EvidenceStatistics::intern(const EventType& type) {
  const EventId id = vocabulary_.intern(type);
  if (id == types_.size()) {
    types_.emplace_back();
    for (std::vector<Pair>& predecessors : pairs_) {
      predecessors.emplace_back();
    }
    pairs_.emplace_back(vocabulary_.size());
  }
  return id;
}

void EvidenceStatistics::merge(const EvidenceStatistics& other) {
  std::vector<EventId> here;
  here.reserve(other.size());
  for (const EventType& type : other.vocabulary_.types()) {
    here.push_back(intern(type));
  }
  for (EventId to = 0; to < here.size(); ++to) {
    const Type& theirs = other.types_[to];
    Type& ours = types_[here[to]];
    ours.events += theirs.events;
    ours.gaps += theirs.gaps;
    ours.gap_sum += theirs.gap_sum;
    ours.rate_sum += theirs.rate_sum;
    ours.rate_squares += theirs.rate_squares;
    for (const std::int64_t gap : theirs.longest_gaps) {
      ours.addGap(gap);
    }
    for (EventId from = 0; from < here.size(); ++from) {
      Pair& pair = pairs_[here[to]][here[from]];
      addDelays(other.pair(from, to).delays, pair.delays);
      pair.answers += other.pair(from, to).answers;
    }
  }
  rate_windows_ += other.rate_windows_;
  duration_ += other.duration_;
}

bool operator==(const EvidenceStatistics& a, const EvidenceStatistics& b) {
  if (a.vocabulary().types() != b.vocabulary().types() || a.rateWindows() != b.rateWindows() ||
      a.duration() != b.duration()) {
    return false;
  }
  for (EventId to = 0; to < a.size(); ++to) {
    const EvidenceStatistics::Type& x = a.type(to);
    const EvidenceStatistics::Type& y = b.type(to);
    if (std::tie(x.events, x.gaps, x.gap_sum, x.longest_gaps, x.rate_sum, x.rate_squares) !=
        std::tie(y.events, y.gaps, y.gap_sum, y.longest_gaps, y.rate_sum, y.rate_squares)) {
      return false;
    }
    for (EventId from = 0; from < a.size(); ++from) {
      if (a.pair(from, to).delays != b.pair(from, to).delays ||
          a.pair(from, to).answers != b.pair(from, to).answers) {
        return false;
      }
    }
  }
  return true;
}

EvidenceTrainer::EvidenceTrainer(EvidenceStatistics& statistics, std::int64_t window)
    : statistics_(statistics), window_(window), counts_(0, rateWindows(window)) {}

void EvidenceTrainer::startRecording() {
  last_seen_.clear();
  last_stamp_.reset();
  number_ = 0;
  counts_.restart();
}

void EvidenceTrainer::add(const Event& event) {
  if (last_stamp_ && isClockStep(*last_stamp_, event.stamp)) {
    startRecording();
  }
  last_seen_.resize(statistics_.size());
  counts_.resize(statistics_.size());
  if (last_stamp_) {
    closeWindows(event.stamp);
    statistics_.addDuration(std::max<std::int64_t>(event.stamp - newest_stamp_, 0));
    newest_stamp_ = std::max(newest_stamp_, event.stamp);
  } else {
    newest_stamp_ = event.stamp;
    window_end_ = floorToGrid(event.stamp, window_) + window_;
  }
  last_stamp_ = event.stamp;

  EvidenceStatistics::Type& type = statistics_.type(event.id);
  std::optional<Seen>& last = last_seen_.at(event.id);
  ++type.events;
  counts_.add(event.id);
  for (EventId other = 0; other < last_seen_.size(); ++other) {
    if (!last_seen_[other]) {
      continue;
    }
    std::vector<std::uint32_t>& delays = statistics_.pair(other, event.id).delays;
    delays.resize(log_bins::kBins, 0);
    ++delays[log_bins::bin(event.stamp - last_seen_[other]->stamp)];
    if (last && last_seen_[other]->number > last->number) {
      ++statistics_.pair(event.id, other).answers;
    }
  }
  if (last) {
    const std::int64_t gap = std::max<std::int64_t>(event.stamp - last->stamp, 0);
    ++type.gaps;
    type.gap_sum += gap;
    type.addGap(gap);
  }
  last = Seen{event.stamp, ++number_};
}

void EvidenceTrainer::closeWindows(std::int64_t now) {
  for (; window_end_ <= now; window_end_ += window_) {
    counts_.close();
    if (!counts_.full()) {
      continue;
    }
    statistics_.addRateWindows(1);
    for (EventId id = 0; id < counts_.counts().size(); ++id) {
      const std::uint64_t count = counts_.counts()[id];
      statistics_.type(id).rate_sum += count;
      statistics_.type(id).rate_squares += count * count;
    }
  }
}

}  // namespace self_awareness::core
