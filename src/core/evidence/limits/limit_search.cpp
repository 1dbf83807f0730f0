#include "core/evidence/limits/limit_search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <set>
#include <utility>

#include "core/evidence/channel/channels.h"
#include "core/evidence/count/starts.h"
#include "core/evidence/limits/heads_and_tails.h"

namespace self_awareness::core::evidence {
namespace {

// What one of three starts shows alone may be what the robot does at times.
constexpr std::size_t kFewestThatAgree = 5;
// A type whose longest gap is below this share of the longest that chance would make is a timer.
constexpr double kFarFromChance = 1.0 / 3;
constexpr double kNoLimit = std::numeric_limits<double>::quiet_NaN();

double hoursOf(std::uint64_t windows, std::int64_t window) {
  return static_cast<double>(windows) * static_cast<double>(window) / kNanosecondsPerHour;
}

double sumOf(const std::vector<Part>& parts) {
  double hours = 0;
  for (const Part& part : parts) {
    hours += part.hours;
  }
  return hours;
}

/// 0: there are fewer than two.
double secondLargest(std::vector<double> values) {
  if (values.size() < 2) {
    return 0;
  }
  std::nth_element(values.begin(), values.begin() + 1, values.end(), std::greater<>());
  return values[1];
}

/// False alarms an hour that limits are made for. By the training alone, they promise one in so
/// many times the time that was seen at best.
double budgetOf(const LimitFinder::Findings& findings, std::int64_t window, double budget,
                double most_of_training) {
  std::uint64_t windows = 0;
  for (const LimitFinder::Recording& recording : findings) {
    if (!recording.trained_on) {
      return budget;
    }
    windows += recording.windows;
  }
  return std::max(budget, 1 / (most_of_training * hoursOf(windows, window)));
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

/// Number of pools that share the budget: silences have three, others one for each label, and
/// those of attributes have a share of their own.
double numberOfPools(const Tuning& tuning) {
  std::set<std::string> labels;
  double of_silences = 0;
  for (const Channel* channel : channels()) {
    if (!tuning.isOn(channel->name()) || channel->hasShareOfItsOwn()) {
      continue;
    }
    if (channel->finding() == Finding::kSilent) {
      of_silences = 3;
    } else {
      labels.insert(channel->label());
    }
  }
  return static_cast<double>(labels.size()) + of_silences;
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
  LeftOut gaps(with_gaps_, tuning_);
  LeftOut evidence(judged_, tuning_);
  std::map<Pool, std::vector<Seen>> pools;
  for (std::size_t track = 0; track < model_.tracks().size(); ++track) {
    if (relations[track].watched) {
      auto [pool, seen] = seenBy(track);
      pools[pool].push_back(std::move(seen));
    }
  }
  lost_ = lossesOf(pools);
  const double all = budgetOf(findings, window, budget, tuning_.most_of_training);
  for (const auto& [pool, tracks] : pools) {
    const Track& any = model_.tracks()[tracks.front().track];
    const double share = any.channel->hasShareOfItsOwn() ? tuning_.share_of_attribute * all
                                                         : all / numberOfPools(tuning_);
    search(pool.first, tracks, share, pool.first == Kind::kEvidence ? evidence : gaps);
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
    longest_recording_ = std::max(longest_recording_, length);
  }
  for (std::size_t k = 0; k < findings.size(); ++k) {
    const double hours = hoursOf(findings[k].windows, window_);
    longest_recording_ = std::max(longest_recording_, hours * kNanosecondsPerHour);
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

std::pair<LimitSearch::Pool, LimitSearch::Seen> LimitSearch::seenBy(std::size_t track) const {
  Seen seen{track, model_.leastLimit(track), {}, {}};
  if (model_.finding(track) == Finding::kSilent) {
    const EventId id = model_.tracks()[track].to;
    seen.largest = gapsOf(id);
    seen.agreed = agreedOn(seen.largest);
    const Kind kind =
        isOftenSilent(model_.statistics(), id, tuning_) ? Kind::kOthers : kindOfGaps(seen);
    if (kind == Kind::kOthers) {
      seen.agreed = seen.largest;  // a pause may be as long as it likes
    }
    return {{kind, ""}, seen};
  }
  for (const LimitFinder::Recording::Part* part : judged_parts_) {
    seen.largest.push_back(part->evidence[track]);
  }
  seen.agreed = seen.largest;
  return {{Kind::kEvidence, channelLabel(model_.tracks()[track])}, seen};
}

std::vector<double> LimitSearch::gapsOf(EventId id) const {
  const HeadsAndTails cut_off(model_.statistics(), id, tuning_);
  std::vector<double> longest;
  for (const Statistics::Recording& recording : model_.statistics().recordings()) {
    const std::int64_t gap = isHeardIn(recording, id) ? recording.longest_gaps[id] : 0;
    const bool lacks = robots_.lacks(recording.robot, id);
    longest.push_back(asTold(std::max(gap, lacks ? 0 : cut_off.longestIn(recording))));
  }
  for (const GapPart& part : gap_parts_) {
    const bool never = !part.of->firsts.empty() && part.of->firsts[id] < 0 &&
                       !robots_.lacks(part.of->robot, id) && cut_off.count();
    longest.push_back(asTold(never ? part.of->end - part.of->start : part.said->longest_gaps[id]));
  }
  return longest;
}

double LimitSearch::asTold(std::int64_t gap) const {
  // Windows tell ages no better than this, and hiccups of a host add to a gap, however long.
  return gap > 0 ? static_cast<double>(gap) + window() : 0;
}

LimitSearch::Kind LimitSearch::kindOfGaps(const Seen& seen) const {
  const double mean_gap = model_.meanGap(model_.tracks()[seen.track].to);
  const double again = secondLargest(seen.agreed);
  const double gap = again > 0 ? again : *std::max_element(seen.agreed.begin(), seen.agreed.end());
  if (gap - window() >= tuning_.regular * mean_gap) {
    return Kind::kOthers;
  }
  return mean_gap < tuning_.fast * window() ? Kind::kFastTimers : Kind::kTimers;
}

std::vector<double> LimitSearch::agreedOn(const std::vector<double>& longest) const {
  const auto worst = std::max_element(longest.begin(), longest.end());
  const std::size_t sample = with_gaps_[static_cast<std::size_t>(worst - longest.begin())].sample;
  double others = 0;
  for (std::size_t part = 0; part < longest.size(); ++part) {
    others = with_gaps_[part].sample == sample ? others : std::max(others, longest[part]);
  }
  const auto stall = static_cast<double>(toNanoseconds(tuning_.longest_stall));
  const double hole = tuning_.most_mean_gaps * others + stall;
  std::vector<double> agreed = longest;
  if (samplesThatHeard(longest) >= kFewestThatAgree) {
    for (double& gap : agreed) {
      gap = gap > hole ? others : gap;
    }
  }
  return agreed;
}

double LimitSearch::lossesOf(const std::map<Pool, std::vector<Seen>>& pools) const {
  double lost = 0;
  double came = 0;
  for (const auto& [pool, tracks] : pools) {
    if (pool.first != Kind::kTimers) {
      continue;
    }
    for (const Seen& seen : tracks) {
      const EventId id = model_.tracks()[seen.track].to;
      const double mean_gap = model_.meanGap(id);
      const double loss = tuning_.regular * mean_gap + window();
      lost += static_cast<double>(
          std::count_if(seen.agreed.begin(), seen.agreed.end(),
                        [=](double gap) { return gap >= loss && gap < loss + mean_gap; }));
      came += numberOf(id);
    }
  }
  return came > 0 ? lost / came : 0;
}

double LimitSearch::numberOf(EventId id) const {
  double heard_for = 0;  // [ns]
  for (const GapPart& part : gap_parts_) {
    heard_for +=
        part.said->longest_gaps[id] > 0 ? static_cast<double>(part.said->windows) * window() : 0;
  }
  return static_cast<double>(model_.statistics().type(id).gaps) + heard_for / model_.meanGap(id);
}

void LimitSearch::search(Kind kind, const std::vector<Seen>& tracks, double share,
                         LeftOut& left_out) {
  const bool timers = kind == Kind::kTimers || kind == Kind::kFastTimers;
  const bool gaps = kind != Kind::kEvidence;
  HeldOut held_out(gaps ? with_gaps_ : judged_, timers ? tuning_.scale_of_timers : tuning_.scale,
                   tuning_);
  for (const Seen& seen : tracks) {
    if (!isOfOneRobot(seen.track)) {
      held_out.add(seen.agreed, seen.least);
    }
  }
  const double told = held_out.margin(share);
  const double rate = share / static_cast<double>(tracks.size());
  for (const Seen& seen : tracks) {
    // A track that would have raised an alarm had its worst start been left out gets a wider
    // limit.
    const bool of_one = isOfOneRobot(seen.track);  // what the others say of it is nothing
    const Margins bounds = model_.tracks()[seen.track].channel->margins(tuning_);
    const double margin = std::clamp(told, bounds.least, bounds.most);
    const double own = gaps || of_one
                           ? margin
                           : std::max(margin, std::min(held_out.excess(seen.agreed, seen.least),
                                                       tuning_.most_own_margin));
    const double largest = *std::max_element(seen.agreed.begin(), seen.agreed.end());
    const Expectation& expected = model_.expectation(seen.track);
    const double found =
        std::max({seen.least, own * std::max(largest, tuning_.share_of_least * seen.least),
                  kind == Kind::kTimers ? withALoss(seen.track, largest, rate) : 0.0});
    const double most =
        gaps ? longestAge(kind, seen, largest - window(), found - window(), rate) : found;
    double& limit = limits_[seen.track];
    limit = expected.limit(seen.track, largest, most);
    if (!std::isnan(limit) && !of_one) {
      left_out.add(seen.largest, seen.agreed, seen.least,
                   gaps ? (most + window()) / largest : margin);
    }
  }
}

double LimitSearch::withALoss(std::size_t track, double largest, double rate) const {
  const double mean_gap = model_.meanGap(model_.tracks()[track].to);
  const bool is_rare = lost_ * kNanosecondsPerHour / mean_gap <= rate;
  const bool has_one = largest - window() >= tuning_.regular * mean_gap;
  return is_rare || has_one ? largest : largest + mean_gap;
}

bool LimitSearch::isOfOneRobot(std::size_t track) const {
  const Track& watched = model_.tracks()[track];
  return robots_.areSeveral() &&
         (robots_.numberWith(watched.to) == 1 || robots_.numberWith(watched.from) == 1);
}

double LimitSearch::longestAge(Kind kind, const Seen& seen, double largest, double age,
                               double rate) const {
  const auto starts = static_cast<double>(samplesThatHeard(seen.agreed));
  const Statistics::Type gaps = gapsWithParts(model_.tracks()[seen.track].to, largest);
  const double rare = tailOf(gaps, seen.track, starts).age(rate);
  if (kind == Kind::kOthers) {
    // Pauses of one start may be a host's hiccups.
    const double most = starts > 1 ? tuning_.most_tail_margin : tuning_.most_tail_margin_of_start;
    age = std::max(age, std::min(rare, most * largest));
  }
  const double told = longest_recording_ / tuning_.pauses_in_recording;
  const double mean_gap = model_.meanGap(model_.tracks()[seen.track].to);
  const double again =
      std::max(secondLargest(seen.agreed) - window(),
               gaps.longest_gaps.size() > 1 ? static_cast<double>(gaps.longest_gaps[1]) : 0);
  if (again > std::max(told, tuning_.most_mean_gaps * mean_gap)) {
    // What comes when something happens may stay away for as long as nothing does. Recordings
    // that are hardly longer than a pause do not say how long that is.
    const double all = sumOf(with_gaps_) * kNanosecondsPerHour;
    age = std::max({age, rare, std::min(all, tuning_.pauses_in_recording * longest_recording_)});
  }
  return age;
}

std::size_t LimitSearch::samplesThatHeard(const std::vector<double>& longest) const {
  std::set<std::size_t> samples;
  for (std::size_t part = 0; part < with_gaps_.size(); ++part) {
    if (longest[part] > 0) {
      samples.insert(with_gaps_[part].sample);
    }
  }
  return samples.size();
}

Statistics::Type LimitSearch::gapsWithParts(EventId id, double longest) const {
  Statistics::Type gaps = model_.statistics().type(id);
  for (const GapPart& part : gap_parts_) {
    gaps.addGap(part.said->longest_gaps[id]);
  }
  const auto agreed =
      std::find_if(gaps.longest_gaps.begin(), gaps.longest_gaps.end(),
                   [=](std::int64_t gap) { return static_cast<double>(gap) <= longest; });
  gaps.longest_gaps.erase(gaps.longest_gaps.begin(), agreed);
  return gaps;
}

GapTail LimitSearch::tailOf(Statistics::Type gaps, std::size_t track, double starts) const {
  const EventId id = model_.tracks()[track].to;
  gaps.longest_gaps.resize(
      std::min(gaps.longest_gaps.size(), static_cast<std::size_t>(tuning_.pauses)));
  const double usual = tuning_.regular * model_.meanGap(id);
  const double cut_off = HeadsAndTails(model_.statistics(), id, tuning_).all();
  // Messages of a timer are lost, or late, each by itself. Chance alone makes gaps of log(n) mean
  // gaps.
  const double by_chance = std::log(static_cast<double>(gaps.gaps));
  const bool has_pauses =
      static_cast<double>(gaps.longestGap()) > kFarFromChance * by_chance * model_.meanGap(id);
  const double prior = has_pauses ? tuning_.prior_pauses : std::numeric_limits<double>::infinity();
  return {gaps.longest_gaps, sumOf(with_gaps_), usual, cut_off, starts, prior};
}

}  // namespace self_awareness::core::evidence
