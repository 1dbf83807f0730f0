#include "self_awareness/core/evidence/count/statistics.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "core/evidence/count/bin_arrays.h"

namespace self_awareness::core::evidence {
namespace {

template <typename Counts>
void addCounts(const Counts& counts, SumOfDelays& sum) {
  asArray(sum) += asArray(counts).template cast<std::uint64_t>();
}

Partners renamed(const Partners& partners, const std::vector<EventId>& here) {
  std::vector<Partner> theirs;
  theirs.reserve(partners.size());
  for (std::size_t k = 0; k < partners.size(); ++k) {
    theirs.push_back(partners.at(k));
    theirs.back().id = here[theirs.back().id];
  }
  std::sort(theirs.begin(), theirs.end(),
            [](const Partner& a, const Partner& b) { return a.id < b.id; });
  Partners ours;
  for (const Partner& partner : theirs) {
    ours.append(partner);
  }
  return ours;
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
  bool same =
      std::tie(a.start, a.end, a.longest_silence, a.longest_stall, a.robot_start, a.robot) ==
      std::tie(b.start, b.end, b.longest_silence, b.longest_stall, b.robot_start, b.robot);
  for (EventId id = 0; same && id < types; ++id) {
    same = at(a.events, id) == at(b.events, id) &&
           at(a.longest_gaps, id) == at(b.longest_gaps, id) && first(a, id) == first(b, id);
  }
  return same;
}

std::vector<Partner> counted(const Partners& partners) {
  std::vector<Partner> counted;
  for (std::size_t k = 0; k < partners.size(); ++k) {
    if (partners.answers(k) > 0 || partners.total(k) > 0) {
      counted.push_back(partners.at(k));
    }
  }
  return counted;
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
    ours.attributes.merge(theirs.attributes);
    for (const std::int64_t gap : theirs.longest_gaps) {
      ours.addGap(gap);
    }
    if (other.partners_[id].size() > 0) {
      partners_[here[id]] = Partners::sum(partners_[here[id]], renamed(other.partners_[id], here));
    }
  }
  for (const Recording& theirs : other.recordings_) {
    Recording ours{theirs.start,
                   theirs.end,
                   theirs.longest_silence,
                   theirs.longest_stall,
                   std::vector<std::uint64_t>(size(), 0),
                   std::vector<std::int64_t>(size(), 0),
                   std::vector<std::int64_t>(size(), -1),
                   theirs.robot_start,
                   theirs.robot};
    for (EventId id = 0; id < theirs.events.size(); ++id) {
      ours.events[here[id]] = theirs.events[id];
      ours.longest_gaps[here[id]] = theirs.longest_gaps[id];
      ours.firsts[here[id]] = theirs.firsts[id];
    }
    addRecording(std::move(ours));
  }
  rate_windows_ += other.rate_windows_;
  duration_ += other.duration_;
  if (!left_out_.empty() || !other.left_out_.empty()) {
    PairSet left_out;
    other.left_out_.forEach([&](EventId to, EventId from) { left_out.add(here[to], here[from]); });
    *this = without(left_out);
  }
}

double Statistics::rateVariance(EventId id) const {
  const auto windows = static_cast<double>(std::max<std::uint64_t>(rate_windows_, 1));
  const double mean = static_cast<double>(type(id).rate_sum) / windows;
  return std::max(static_cast<double>(type(id).rate_squares) / windows - mean * mean, 0.0);
}

double Statistics::dispersion(EventId id) const {
  const auto sum = static_cast<double>(std::max<std::uint64_t>(type(id).rate_sum, 1));
  return std::max(rateVariance(id) * static_cast<double>(rate_windows_) / sum, 1.0);
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

DelayHistogram Statistics::delays(EventId from, EventId to) const {
  const std::optional<std::size_t> place = partners_.at(to).find(from);
  return place ? partners_[to].at(*place).delays : DelayHistogram{};
}

std::uint64_t Statistics::total(EventId from, EventId to) const {
  const std::optional<std::size_t> place = partners_.at(to).find(from);
  return place ? partners_[to].total(*place) : 0;
}

std::uint64_t Statistics::answers(EventId from, EventId to) const {
  const std::optional<std::size_t> place = partners_.at(from).find(to);
  return place ? partners_[from].answers(*place) : 0;
}

void Statistics::setPartners(EventId id, Partners partners) {
  if (partners.size() > 0 && partners.id(partners.size() - 1) >= size()) {
    throw std::invalid_argument("partners of an event type must be event types, in order");
  }
  partners_.at(id) = std::move(partners);
}

void Statistics::count(EventId id, const std::vector<std::uint8_t>& bins,
                       const std::vector<std::uint8_t>& came) {
  partners_.at(id).makeAll(size());
  partners_[id].count(bins, came);
}

std::vector<SumOfDelays> Statistics::delaysToAny() const {
  std::vector<SumOfDelays> sums;
  sums.reserve(size());
  for (const Type& type : types_) {
    sums.push_back(type.left_out);
  }
  for (EventId to = 0; to < size(); ++to) {
    for (std::size_t k = 0; k < partners_[to].size() && !vocabulary_.tellsMode(to); ++k) {
      addCounts(partners_[to].at(k).delays, sums[partners_[to].id(k)]);
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
  for (std::vector<EventId>& of_type : kept) {
    std::sort(of_type.begin(), of_type.end());
  }
  return filtered([&](EventId to, EventId from) {
    return std::binary_search(kept[to].begin(), kept[to].end(), from);
  });
}

Statistics Statistics::without(const PairSet& pairs) const {
  PairSet left_out = left_out_;
  pairs.forEach([&](EventId to, EventId from) { left_out.add(to, from); });
  Statistics rest =
      filtered([&](EventId to, EventId from) { return !left_out.contains(to, from); });
  rest.left_out_ = std::move(left_out);
  return rest;
}

template <typename Keep>
Statistics Statistics::filtered(Keep keep) const {
  Statistics rest = withoutPairs();
  for (EventId to = 0; to < size(); ++to) {
    addCounts(types_[to].left_out, rest.types_[to].left_out);
  }
  for (EventId to = 0; to < size(); ++to) {
    for (std::size_t k = 0; k < partners_[to].size(); ++k) {
      const Partner partner = partners_[to].at(k);
      if (keep(to, partner.id)) {
        rest.partners_[to].append(partner);
      } else if (!vocabulary_.tellsMode(to)) {
        addCounts(partner.delays, rest.types_[partner.id].left_out);
      }
    }
  }
  return rest;
}

void Statistics::leaveOut(EventId from, EventId to) {
  if (from >= size() || to >= size() || total(from, to) > 0) {
    throw std::invalid_argument("pairs that were left out must be of event types, without counts");
  }
  left_out_.add(to, from);
}

bool operator==(const Statistics& a, const Statistics& b) {
  if (a.vocabulary().types() != b.vocabulary().types() || a.rateWindows() != b.rateWindows() ||
      a.duration() != b.duration() || !(a.leftOut() == b.leftOut()) ||
      !std::equal(a.recordings().begin(), a.recordings().end(), b.recordings().begin(),
                  b.recordings().end(),
                  [&](const auto& x, const auto& y) { return isSame(x, y, a.size()); })) {
    return false;
  }
  for (EventId id = 0; id < a.size(); ++id) {
    const Statistics::Type& x = a.type(id);
    const Statistics::Type& y = b.type(id);
    if (std::tie(x.events, x.gaps, x.gap_sum, x.longest_gaps, x.rate_sum, x.rate_squares,
                 x.left_out, x.attributes) != std::tie(y.events, y.gaps, y.gap_sum, y.longest_gaps,
                                                       y.rate_sum, y.rate_squares, y.left_out,
                                                       y.attributes) ||
        !(counted(a.partners(id)) == counted(b.partners(id)))) {
      return false;
    }
  }
  return true;
}

}  // namespace self_awareness::core::evidence
