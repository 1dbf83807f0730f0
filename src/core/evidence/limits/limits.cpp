#include "self_awareness/core/evidence/limits/limits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/evidence/channel/channel.h"
#include "core/evidence/channel/scorer.h"
#include "core/evidence/limits/limit_search.h"
#include "core/evidence/limits/misleading_pairs.h"
#include "core/evidence/watch/heads_and_tails.h"
#include "core/evidence/watch/relations.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kNotSettled = std::numeric_limits<std::int64_t>::max();

}  // namespace

void LimitFinder::Parameters::validate() const {
  if (window <= 0 || settle_time < 0) {
    throw std::invalid_argument("window must be more than 0 ns, settle_time 0 or more");
  }
}

LimitFinder::LimitFinder(std::shared_ptr<const Model> model, const Parameters& parameters,
                         SourceGraph graph)
    : model_(std::move(model)),
      parameters_(parameters),
      graph_(std::move(graph)),
      windows_(parameters.window, *this),
      misleading_(std::make_unique<MisleadingPairs>(*model_)) {
  parameters_.validate();
}

LimitFinder::~LimitFinder() = default;

void LimitFinder::startRecording(std::shared_ptr<const Model> model, std::int64_t robot_start,
                                 std::string robot) {
  finish();
  judging_ = std::move(model);
  robot_start_ = robot_start;
  robot_ = std::move(robot);
  firsts_.assign(judging_ == model_ ? model_->size() : 0, -1);
  startScoring();
}

void LimitFinder::startScoring() {
  scorer_ = std::make_unique<Scorer>(judging_, parameters_.window);
  scorer_->leaveOut(Finding::kSilent);  // the longest gaps say it
  settled_at_.assign(model_->size(), kNotSettled);
  settling_.clear();
  heard_now_.assign(model_->size(), false);
  waiting_.assign(model_->tracks().size(), 0);
  stood_still_until_ = 0;
  recording_ = {};
  recording_.robot_start = robot_start_;
  recording_.robot = robot_;
  recording_.trained_on = judging_ != model_;
  part_windows_ = static_cast<std::uint64_t>(std::max<std::int64_t>(
      toNanoseconds(model_->tuning().shortest_part) / parameters_.window, 1));
}

void LimitFinder::hear(const Waiting& waiting) {
  scorer_->hear(waiting);
  if (waiting.stoodStill()) {
    stood_still_until_ = waiting.to;
  }
}

void LimitFinder::add(const Event& event) {
  windows_.add(event);
}

std::optional<ObservedEvent> LimitFinder::observe(const Event& event) {
  if (!first_stamp_) {
    first_stamp_ = event.stamp;
    recording_.start = event.stamp;
    startPart();
  }
  recording_.end = event.stamp;
  if (model_->vocabulary().tellsMode(event.id)) {
    scorer_->enter(event);
    return std::nullopt;
  }
  if (event.id < firsts_.size() && firsts_[event.id] < 0) {
    firsts_[event.id] = std::max<std::int64_t>(event.stamp - *first_stamp_, 0);
  }
  if (!model_->vocabulary().isMessage(event.id)) {
    return std::nullopt;
  }
  if (event.id < settled_at_.size() && settled_at_[event.id] == kNotSettled) {
    settled_at_[event.id] = event.stamp + parameters_.settle_time;
    settling_.push_back(event.id);
    endHeadOrTail(event.id, event.stamp - *first_stamp_);
  }
  const ObservedEvent observed{event, !model_->knows(event.id), scorer_->add(event)};
  if (!observed.unknown) {
    heard_now_[event.id] = true;
    if (observed.gap && hasSettled(event.stamp)) {
      std::int64_t& longest = recording_.parts.back().longest_gaps[event.id];
      longest = std::max(longest, *observed.gap);
    }
    misleading_->add(event);
  }
  return observed;
}

void LimitFinder::restart() {
  windows_.restart();
  onClockStep();
}

void LimitFinder::onClockStep() {
  const std::optional<EventId> mode = scorer_->heard().mode();
  endRecording();
  startScoring();
  scorer_->enterBefore(mode);
}

void LimitFinder::finish() {
  windows_.finish();
  recording_.firsts = std::move(firsts_);
  firsts_.clear();
  endRecording();
}

void LimitFinder::startPart() {
  if (recording_.parts.size() == kMostParts) {
    joinParts();
  }
  Recording::Part part;
  part.evidence.resize(model_->tracks().size());
  part.longest_gaps.resize(model_->size());
  recording_.parts.push_back(std::move(part));
}

void LimitFinder::joinParts() {
  const auto largest = [](auto& values, const auto& others) {
    std::transform(values.begin(), values.end(), others.begin(), values.begin(),
                   [](auto a, auto b) { return std::max(a, b); });
  };
  for (std::size_t k = 0; k < kMostParts / 2; ++k) {
    Recording::Part& part = recording_.parts[2 * k];
    const Recording::Part& next = recording_.parts[2 * k + 1];
    part.windows += next.windows;
    largest(part.evidence, next.evidence);
    largest(part.longest_gaps, next.longest_gaps);
    if (k > 0) {
      recording_.parts[k] = std::move(part);
    }
  }
  recording_.parts.resize(kMostParts / 2);
  part_windows_ *= 2;
}

void LimitFinder::endRecording() {
  if (!first_stamp_) {
    return;
  }
  first_stamp_.reset();
  for (EventId id = 0; id < model_->size(); ++id) {
    if (const std::optional<std::int64_t> last = scorer_->heard().lastSeen(id)) {
      endHeadOrTail(id, recording_.end - *last);
    }
  }
  misleading_->finish();
  recording_.said = misleading_->takeFindings();
  findings_.push_back(std::move(recording_));
  recording_ = {};
}

void LimitFinder::endHeadOrTail(EventId id, std::int64_t length) {
  const bool counts = isOftenSilent(model_->statistics(), id, model_->tuning());
  Recording::Part& part = recording_.parts.back();
  part.longest_gaps[id] = std::max(part.longest_gaps[id], counts ? length : 0);
  for (std::size_t track = 0; track < waiting_.size(); ++track) {
    if (model_->tracks()[track].to == id) {
      part.evidence[track] = std::max(part.evidence[track], counts ? waiting_[track] : 0);
      waiting_[track] = 0;
    }
  }
}

void LimitFinder::close(const Window& window, std::int64_t end) {
  if (end < window.start + parameters_.window) {
    return;  // the recording ends within its last window
  }
  forgetStarts(window.start);
  const std::vector<double>& evidence = scorer_->closeWindow(end);
  std::vector<bool> heard(model_->size(), false);
  heard.swap(heard_now_);
  if (end - parameters_.window < *first_stamp_ + parameters_.settle_time ||
      !hasSettled(end - parameters_.window)) {
    return;
  }
  if (recording_.parts.back().windows == part_windows_) {
    startPart();
  }
  Recording::Part& part = recording_.parts.back();
  ++part.windows;
  ++recording_.windows;
  for (std::size_t track = 0; track < evidence.size(); ++track) {
    const Track& watched = model_->tracks()[track];
    if (evidence[track] > 0 &&
        !(watched.channel->isOfAttributes() && window.start < settled_at_[watched.to])) {
      waiting_[track] = std::max(waiting_[track], static_cast<float>(evidence[track]));
    }
    if (heard[watched.to]) {
      part.evidence[track] = std::max(part.evidence[track], waiting_[track]);
      waiting_[track] = 0;
    }
  }
}

void LimitFinder::forgetStarts(std::int64_t now) {
  const auto settles = std::partition(settling_.begin(), settling_.end(),
                                      [&](EventId id) { return now < settled_at_[id]; });
  std::for_each(settles, settling_.end(), [&](EventId id) { scorer_->forgetAttributes(id); });
  settling_.erase(settles, settling_.end());
}

std::uint64_t LimitFinder::windows() const {
  std::uint64_t windows = 0;
  for (const Recording& recording : findings_) {
    windows += recording.windows;
  }
  return windows;
}

LimitFinder::Found LimitFinder::find(double budget) const {
  if (!(budget > 0) || !std::isfinite(budget)) {
    throw std::invalid_argument("the budget of false alarms an hour must be more than 0");
  }
  if (model_->tracks().empty()) {
    throw std::invalid_argument("the model watches nothing, as no event type has " +
                                std::to_string(std::llround(model_->tuning().fewest_gaps)) +
                                " gaps in its training: train it on more");
  }
  // What the training showed does not replace recordings that it has never seen.
  const bool held_out =
      std::any_of(findings_.begin(), findings_.end(),
                  [](const Recording& recording) { return !recording.trained_on; });
  std::uint64_t windows = 0;
  for (const Recording& recording : findings_) {
    windows += recording.trained_on && held_out ? 0 : recording.windows;
  }
  if (static_cast<std::int64_t>(windows) * parameters_.window <
      toNanoseconds(model_->tuning().least_time)) {
    throw std::invalid_argument("too little normal operation to find limits: at least " +
                                std::to_string(std::llround(model_->tuning().least_time)) +
                                " s are needed after the first seconds of every recording");
  }
  Found found;
  found.relations = findRelations();
  const LimitSearch search(*model_, findings_, found.relations, parameters_.window, budget);
  found.limits.tracks = search.limits();
  found.limits.firsts = latestFirsts();
  found.promised_rate = search.rate();
  return found;
}

std::vector<std::int64_t> LimitFinder::latestFirsts() const {
  std::vector<std::int64_t> latest;
  for (const Recording& recording : findings_) {
    if (recording.firsts.empty()) {
      continue;
    }
    if (latest.empty()) {
      latest = recording.firsts;
    }
    std::transform(latest.begin(), latest.end(), recording.firsts.begin(), latest.begin(),
                   [](std::int64_t one, std::int64_t other) {
                     return one < 0 || other < 0 ? -1 : std::max(one, other);
                   });
  }
  return latest;
}

void LimitFinder::merge(const Findings& other) {
  for (const Recording& recording : other) {
    if (!recording.firsts.empty() && recording.firsts.size() != model_->size()) {
      throw std::invalid_argument("the findings are those of another model");
    }
    for (const Recording::Part& part : recording.parts) {
      if (part.evidence.size() != model_->tracks().size() ||
          part.longest_gaps.size() != model_->size()) {
        throw std::invalid_argument("the findings are those of another model");
      }
    }
  }
  findings_.insert(findings_.end(), other.begin(), other.end());
}

std::vector<Relation> LimitFinder::findRelations() const {
  const Relations relations(model_->statistics(), graph_, model_->tuning());
  std::vector<Relation> found;
  for (std::size_t track = 0; track < model_->tracks().size(); ++track) {
    const Track& watched = model_->tracks()[track];
    const bool may_mislead = watched.channel->mayMislead();
    std::vector<Span> as_usual;
    bool misleads = false;
    for (const Recording& recording : findings_) {
      if (!recording.trained_on && recording.said[track] == Said::kAsUsual) {
        as_usual.push_back(
            {recording.start, recording.end, recording.robot_start, recording.robot});
      }
      misleads = misleads || (may_mislead && recording.said[track] == Said::kMisleading);
    }
    Relation& relation = found.emplace_back(watched.channel->reason(watched, relations, as_usual));
    relation.watched = relation.watched && !misleads;
  }
  return found;
}

}  // namespace self_awareness::core::evidence
