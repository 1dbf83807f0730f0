#include "core/evidence/limits/limit_search.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "core/evidence/channel/channel.h"
#include "core/evidence/count/starts.h"
#include "core/evidence/limits/gap_tail.h"
#include "core/evidence/watch/heads_and_tails.h"

namespace self_awareness::core::evidence {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::quiet_NaN();

double hoursOf(std::uint64_t windows, std::int64_t window) {
  return static_cast<double>(windows) * static_cast<double>(window) / kNanosecondsPerHour;
}

double largestIn(const std::vector<double>& values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

/// 0: there are fewer than two.
double secondLargest(std::vector<double> values) {
  if (values.size() < 2) {
    return 0;
  }
  std::nth_element(values.begin(), values.begin() + 1, values.end(), std::greater<>());
  return values[1];
}

/// Adds what came in a recording that was not trained on.
void addTo(Robots& robots, const LimitFinder::Recording& recording) {
  if (recording.firsts.empty()) {
    return;  // it does not say
  }
  robots.add(recording.robot);
  for (EventId id = 0; id < recording.firsts.size(); ++id) {
    if (recording.firsts[id] >= 0) {
      robots.add(recording.robot, id);
    }
  }
}

}  // namespace

LimitSearch::LimitSearch(const Model& model, const LimitFinder::Findings& findings,
                         const std::vector<Relation>& relations, std::int64_t window,
                         double budget)
    : model_(model),
      tuning_(model.tuning()),
      window_(window),
      limits_(model.tracks().size(), kNoLimit) {
  robots_.add(model.statistics());
  gatherParts(findings);
  LeftOut gaps(with_gaps_);
  LeftOut evidence(judged_);
  std::vector<Gaps> silences;
  double watched = 0;
  for (std::size_t track = 0; track < limits_.size(); ++track) {
    if (!relations[track].watched) {
      continue;
    }
    watched += 1;
    if (model.finding(track) == Finding::kSilent) {
      silences.push_back(gapsOf(track));
    } else {
      limitEvidence(track, evidence);
    }
  }
  leaveHolesOut(silences);
  lost_ = lossesOf(silences);
  spread_ = spreadOf(silences);
  for (const Gaps& each : silences) {
    limitSilence(each, budget / watched, gaps);
  }
  rate_ =
      highestRate(gaps.exceeded() + evidence.exceeded(), std::max(gaps.hours(), evidence.hours()));
}

void LimitSearch::gatherParts(const LimitFinder::Findings& findings) {
  const std::vector<Statistics::Recording>& training = model_.statistics().recordings();
  std::vector<Span> spans;
  spans.reserve(training.size() + findings.size());
  for (const Statistics::Recording& recording : training) {
    spans.push_back({recording.start, recording.end, recording.robot_start, recording.robot});
  }
  for (const LimitFinder::Recording& recording : findings) {
    spans.push_back({recording.start, recording.end, recording.robot_start, recording.robot});
    addTo(robots_, recording);
  }
  const std::vector<std::size_t> samples = samplesOf(spans, toNanoseconds(tuning_.start_time));
  for (std::size_t k = 0; k < training.size(); ++k) {
    const auto length = static_cast<double>(training[k].end - training[k].start);
    with_gaps_.push_back({samples[k], length / kNanosecondsPerHour});
  }
  for (std::size_t k = 0; k < findings.size(); ++k) {
    for (const LimitFinder::Recording::Part& part : findings[k].parts) {
      const Part its{samples[training.size() + k], hoursOf(part.windows, window_)};
      judged_.push_back(its);
      judged_parts_.push_back(&part);
      if (!findings[k].trained_on) {
        with_gaps_.push_back(its);
        gap_parts_.push_back({&part, &findings[k]});
      }
    }
  }
}

LimitSearch::Gaps LimitSearch::gapsOf(std::size_t track) const {
  const EventId id = model_.tracks()[track].to;
  const HeadsAndTails cut_off(model_.statistics(), id, tuning_);
  Gaps gaps;
  gaps.track = track;
  gaps.cut_off = cut_off.all();
  for (const Statistics::Recording& recording : model_.statistics().recordings()) {
    const bool heard = isHeardIn(recording, id);
    const std::int64_t silent =
        robots_.lacks(recording.robot, id) ? 0 : cut_off.longestIn(recording);
    gaps.longest.push_back(asTold(std::max(heard ? recording.longest_gaps[id] : 0, silent)));
    gaps.cut_off += heard ? 0 : static_cast<double>(silent);
  }
  const LimitFinder::Recording* before = nullptr;
  for (const GapPart& part : gap_parts_) {
    const bool throughout = lacks(*part.of, id, cut_off.count());
    const std::int64_t length = part.of->end - part.of->start;
    gaps.longest.push_back(asTold(throughout ? length : part.said->longest_gaps[id]));
    gaps.cut_off += throughout && part.of != before ? static_cast<double>(length) : 0;
    before = part.of;
  }
  gaps.agreed = gaps.longest;
  gaps.largest = largestIn(gaps.agreed);
  if (!cut_off.count()) {  // else it pauses, for as long as it likes
    findHole(gaps);
  }
  return gaps;
}

double LimitSearch::asTold(std::int64_t gap) const {
  // Windows tell ages no better than this, and hiccups of a host add to a gap, however long.
  return gap > 0 ? static_cast<double>(gap) + window() : 0;
}

bool LimitSearch::lacks(const LimitFinder::Recording& recording, EventId id,
                        bool often_silent) const {
  return often_silent && !recording.firsts.empty() && recording.firsts[id] < 0 &&
         !robots_.lacks(recording.robot, id);
}

void LimitSearch::findHole(Gaps& gaps) const {
  const auto worst = std::max_element(gaps.longest.begin(), gaps.longest.end());
  const std::size_t sample =
      with_gaps_[static_cast<std::size_t>(worst - gaps.longest.begin())].sample;
  for (std::size_t part = 0; part < gaps.longest.size(); ++part) {
    if (with_gaps_[part].sample != sample) {
      gaps.without_hole = std::max(gaps.without_hole, gaps.longest[part]);
    }
  }
  const auto stall = static_cast<double>(toNanoseconds(tuning_.longest_stall));
  // Where no other start knows the type, all that it shows may be one.
  if (gaps.without_hole <= 0 || *worst > tuning_.most_mean_gaps * gaps.without_hole + stall) {
    gaps.hole_in = sample;
  }
}

void LimitSearch::leaveHolesOut(std::vector<Gaps>& all) const {
  std::map<std::size_t, std::set<std::size_t>> components;  // by start
  for (const Gaps& gaps : all) {
    if (gaps.hole_in && gaps.without_hole > 0) {
      components[*gaps.hole_in].insert(model_.componentIndex(model_.tracks()[gaps.track].to));
    }
  }
  for (Gaps& gaps : all) {
    if (gaps.hole_in && gaps.without_hole > 0 &&
        static_cast<double>(components[*gaps.hole_in].size()) >= tuning_.several) {
      gaps.hole_in.reset();
    }
    // What one of fewer starts shows alone may be what the robot does at times.
    if (gaps.hole_in && static_cast<double>(longestOfStarts(gaps).size()) > tuning_.several) {
      for (double& gap : gaps.agreed) {
        gap = std::min(gap, gaps.without_hole);
      }
      gaps.largest = gaps.without_hole;
    }
  }
}

double LimitSearch::lossesOf(const std::vector<Gaps>& all) const {
  double lost = 0;
  double came = 0;
  for (const Gaps& gaps : all) {
    const EventId id = model_.tracks()[gaps.track].to;
    const double mean_gap = model_.meanGap(id);
    const double loss = tuning_.regular * mean_gap + window();
    const double again = secondLargest(gaps.agreed);
    if (mean_gap <= 0 || mean_gap < tuning_.fast * window() ||
        (again > 0 ? again : gaps.largest) >= loss) {
      continue;
    }
    lost +=
        static_cast<double>(std::count_if(gaps.agreed.begin(), gaps.agreed.end(), [=](double gap) {
          return gap >= loss && gap < loss + mean_gap;
        }));
    came += numberOf(id);
  }
  // Queues lose what comes fast, and nothing else: then so many slow ones come without a loss.
  const double told = model_.shareOfLosses();
  return came > 0 && (lost > 0 || told * came > -std::log(tuning_.rare)) ? lost / came : told;
}

double LimitSearch::numberOf(EventId id) const {
  double heard_for = 0;  // [ns]
  for (const GapPart& part : gap_parts_) {
    heard_for +=
        part.said->longest_gaps[id] > 0 ? static_cast<double>(part.said->windows) * window() : 0;
  }
  return static_cast<double>(model_.statistics().type(id).gaps) + heard_for / model_.meanGap(id);
}

void LimitSearch::limitSilence(const Gaps& gaps, double rate, LeftOut& left_out) {
  const double mean_gap = model_.meanGap(model_.tracks()[gaps.track].to);
  const bool loses = lost_ * kNanosecondsPerHour / mean_gap > rate &&
                     gaps.largest - window() < tuning_.regular * mean_gap;
  const double told =
      std::max({tuning_.margin_of_silence * gaps.largest, loses ? gaps.largest + mean_gap : 0.0,
                rareAge(gaps, rate) + window()});
  constexpr double kPerSecond = kNanosecondsPerSecond;
  if (limit(gaps.track, gaps.largest / kPerSecond, (told - window()) / kPerSecond)) {
    left_out.add(gaps.longest, gaps.agreed, 0, told / gaps.largest);
  }
}

void LimitSearch::limitEvidence(std::size_t track, LeftOut& left_out) {
  std::vector<double> seen;
  for (const LimitFinder::Recording::Part* part : judged_parts_) {
    seen.push_back(part->evidence[track]);
  }
  const Finding finding = model_.finding(track);
  const bool waits = finding == Finding::kUnanswered || finding == Finding::kAbsent;
  const double margin = waits ? tuning_.margin_of_waiting : tuning_.margin;
  const double least = model_.leastLimit(track);
  const double largest = largestIn(seen);
  if (limit(track, largest, std::max(least, margin * largest))) {
    left_out.add(seen, seen, least, margin);
  }
}

bool LimitSearch::limit(std::size_t track, double largest, double most) {
  limits_[track] = model_.expectation(track).limit(track, largest, most);
  return !std::isnan(limits_[track]) && !isOfOneRobot(track);
}

bool LimitSearch::isOfOneRobot(std::size_t track) const {
  const Track& watched = model_.tracks()[track];
  return robots_.areSeveral() &&
         (robots_.numberWith(watched.to) == 1 || robots_.numberWith(watched.from) == 1);
}

std::vector<double> LimitSearch::longestOfStarts(const Gaps& gaps) const {
  std::map<std::size_t, double> longest;
  for (std::size_t part = 0; part < with_gaps_.size(); ++part) {
    if (gaps.longest[part] > 0) {
      double& of_start = longest[with_gaps_[part].sample];
      of_start = std::max(of_start, gaps.agreed[part]);
    }
  }
  std::vector<double> sorted;
  sorted.reserve(longest.size());
  for (const auto& [start, gap] : longest) {
    sorted.push_back(gap);
  }
  std::sort(sorted.rbegin(), sorted.rend());
  return sorted;
}

double LimitSearch::spreadOf(const std::vector<Gaps>& all) const {
  double number = tuning_.several;
  double sum = number * tuning_.usual_spread;
  for (const Gaps& gaps : all) {
    const std::vector<double> longest = longestOfStarts(gaps);
    const std::size_t half = longest.size() / 2;
    if (half == 0 || gaps.largest - window() <=
                         tuning_.regular * model_.meanGap(model_.tracks()[gaps.track].to)) {
      continue;
    }
    number += 1;
    for (std::size_t k = 0; k < half; ++k) {
      sum += std::log(longest[k] / longest[half]) / static_cast<double>(half);
    }
  }
  return sum / number;
}

double LimitSearch::rareAge(const Gaps& gaps, double rate) const {
  const EventId id = model_.tracks()[gaps.track].to;
  Statistics::Type type = model_.statistics().type(id);
  for (const GapPart& part : gap_parts_) {
    type.addGap(part.said->longest_gaps[id]);
  }
  std::vector<std::int64_t>& longest = type.longest_gaps;
  longest.erase(longest.begin(),
                std::find_if(longest.begin(), longest.end(), [&](std::int64_t gap) {
                  return static_cast<double>(gap) <= gaps.largest - window();
                }));
  if (longest.empty()) {
    return 0;
  }
  // What is late, or lost, each by itself makes gaps of log(n) mean gaps by chance. Longer ones
  // are pauses, and few starts tell little of how long these get.
  const double mean_gap = model_.meanGap(id);
  const double by_chance = std::log(static_cast<double>(type.gaps)) * mean_gap;
  const double usual = tuning_.regular * mean_gap;
  const auto starts = static_cast<double>(longestOfStarts(gaps).size());
  const double samples = (starts + std::pow(tuning_.usual_spread / spread_, 2)) *
                         std::max(1.0, by_chance / static_cast<double>(longest.front()));
  longest.resize(std::min(longest.size(), static_cast<std::size_t>(tuning_.pauses)));
  const double hours =
      std::accumulate(with_gaps_.begin(), with_gaps_.end(), 0.0,
                      [](double sum, const Part& part) { return sum + part.hours; });
  const double age = GapTail(longest, hours, usual, gaps.cut_off, samples).age(rate);
  return gaps.hole_in ? std::min(age, tuning_.margin * (gaps.largest - window())) : age;
}

}  // namespace self_awareness::core::evidence
