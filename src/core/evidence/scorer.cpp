#include "core/evidence/scorer.h"

#include <algorithm>
#include <utility>

#include "core/evidence/log_bins.h"

namespace self_awareness::core::evidence {
namespace {

// The drift of the slow sums: a small one lets weak evidence add up.
constexpr double kSlowDrift = 0.5;
constexpr double kUsualMisses = 0.15;  // share of the gaps above that of training
constexpr double kMostEvidence = 200;  // while limits are not known
// Smaller shares of a limit are what normal operation is made of: they link nothing.
constexpr double kLeastLinked = 0.5;

}  // namespace

inline bool Scorer::arm(Arming& arming, double excess, double usual) const {
  arming.excess += excess;
  const std::uint32_t needed = arming_events_ << std::min(arming.failures, most_failures_);
  if (++arming.events < needed) {
    return false;
  }
  const bool armed = arming.excess <= usual * needed;
  arming = {0, 0, arming.failures + (armed ? 0 : 1)};
  return armed;
}

Scorer::Scorer(std::shared_ptr<const Model> model, std::int64_t window)
    : model_(std::move(model)), counts_(model_->size(), rateWindows(window)) {
  const Tuning& tuning = model_->tuning();
  drift_ = tuning.drift;
  regime_ = toNanoseconds(tuning.regime);
  arming_events_ = static_cast<std::uint32_t>(tuning.arming_events);
  most_failures_ = static_cast<std::uint32_t>(tuning.most_failures);
  usual_surprise_ = tuning.usual_surprise;
  most_behind_ = tuning.most_behind;
  longest_stall_ = toNanoseconds(tuning.longest_stall);
  between_stalls_ = toNanoseconds(tuning.between_stalls);
  start_time_ = toNanoseconds(tuning.start_time);
  addTracks();
  longest_silence_ = std::max(
      std::llround(static_cast<double>(model_->longestSilence()) * tuning.longest_usual_stall),
      std::llround(tuning.shortest_stall * 1e9));
  restart();
}

void Scorer::addTracks() {
  const std::vector<Track>& tracks = model_->tracks();
  std::vector<std::vector<std::size_t>> pairs(model_->size());      // tracks by `to`
  std::vector<std::vector<std::size_t>> answers(model_->size());    // tracks by `from`
  std::vector<std::vector<std::size_t>> deadlines(model_->size());  // tracks by `from`
  tracks_of_.resize(model_->size());
  for (std::size_t track = 0; track < tracks.size(); ++track) {
    const auto& [channel, to, from] = tracks[track];
    if (channel == Channel::kDeadline) {
      deadlines[from].push_back(track);
      continue;
    }
    if (channel == Channel::kDelay) {
      pairs[to].push_back(track);
    } else if (channel == Channel::kAnswer) {
      answers[from].push_back(track);
    } else {
      continue;
    }
    tracks_of_[to].push_back(track);
    if (from != to) {
      tracks_of_[from].push_back(track);
    }
  }
  state_of_.resize(tracks.size());
  Sums none;
  none.caps.setConstant(kMostEvidence);
  for (EventId id = 0; id < model_->size(); ++id) {
    OfType type;
    type.gone_after = static_cast<std::int64_t>(
        std::min(model_->tuning().gone_gaps * static_cast<double>(model_->longestGap(id)), 9e18));
    type.mean_gap = model_->meanGap(id);
    type.pairs_begin = static_cast<std::uint32_t>(pairs_.size());
    for (const std::size_t track : pairs[id]) {
      state_of_[track] = state_of_[track + 1] = pairs_.size();
      pairs_.push_back({tracks[track].from, tracks[track].from == id, false,
                        model_->surprises(track).data(), 0, none});
      harmless_.push_back(&model_->harmless(track));
    }
    type.pairs_end = static_cast<std::uint32_t>(pairs_.size());
    type.answers_begin = static_cast<std::uint32_t>(answers_.size());
    for (const std::size_t track : answers[id]) {
      state_of_[track] = answers_.size();
      Answer& answer = answers_.emplace_back();
      answer.to = tracks[track].to;
      answer.usual_delay = model_->usualAnswer(track);
      answer.answered = model_->answered(track);
      answer.missed = model_->missed(track);
      answer.usual = model_->missRate(track);
      answer.cap = kMostEvidence;
    }
    type.answers_end = static_cast<std::uint32_t>(answers_.size());
    type.deadlines_begin = static_cast<std::uint32_t>(deadlines_.size());
    for (const std::size_t track : deadlines[id]) {
      state_of_[track] = deadlines_.size();
      deadlines_.push_back({tracks[track].to, model_->countsRequests(track), 0, 0});
    }
    type.deadlines_end = static_cast<std::uint32_t>(deadlines_.size());
    types_.push_back(std::move(type));
  }
  for (std::uint32_t number = 0; number < deadlines_.size(); ++number) {
    types_[deadlines_[number].to].answered_deadlines.push_back(number);
  }
}

void Scorer::restart() {
  stamps_.assign(model_->size(), 0);
  first_stamps_.assign(model_->size(), 0);
  behind_.assign(model_->size(), 0);
  numbers_.assign(model_->size(), 0);
  seen_.assign(model_->size(), 0);
  number_ = 0;
  last_stamp_ = stall_ = stalled_at_ = stalled_until_ = 0;
  counts_.restart();
  evidence_.assign(model_->tracks().size(), 0);
  pairs_arming_.assign(pairs_.size(), {});
  answers_arming_.assign(answers_.size(), {});
  pairs_abnormal_since_.assign(pairs_.size(), 0);
  answers_abnormal_since_.assign(answers_.size(), 0);
  for (std::size_t pair = 0; pair < pairs_.size(); ++pair) {
    disarmPair(pair);
  }
  for (std::size_t answer = 0; answer < answers_.size(); ++answer) {
    disarmAnswer(answer);
  }
  for (Deadline& deadline : deadlines_) {
    deadline.requests = 0;
  }
}

std::optional<std::int64_t> Scorer::add(const Event& event) {
  if (event.id >= types_.size()) {
    return std::nullopt;
  }
  const OfType& type = types_[event.id];
  counts_.add(event.id);
  // Constant local copies: the compiler would look up again what it does not know to be constant.
  const std::int64_t* const stamps = stamps_.data();
  const std::uint64_t* const numbers = numbers_.data();
  const std::uint64_t last = numbers[event.id];
  const Eigen::Array2d drifts(drift_, kSlowDrift);
  start_ = number_ == 0 ? event.stamp : start_;
  noteStall(event.stamp);
  const bool stalled = event.stamp < stalled_until_;
  const std::int64_t last_stamp = last > 0 ? stamps[event.id] : event.stamp;
  const bool catches_up = last > 0 && catchUp(event);
  // Pairs with a type that was never seen are not armed: arming takes back what is added to their
  // sums here. So the many others need no check.
  DelayPair* const pairs_end = pairs_.data() + type.pairs_end;
  for (DelayPair* pair = pairs_.data() + type.pairs_begin; pair != pairs_end; ++pair) {
    // Only the first event after another counts: later ones, while the other pauses, would count
    // one pause many times. No branch, since the processor cannot predict which one is first.
    const bool first = numbers[pair->from] >= last;
    const std::int64_t delay = event.stamp - stamps[pair->from];
    double surprise = pair->surprises[log_bins::bin(delay)];
    if (surprise > Model::kSurprising &&  // seldom
        harmless_[static_cast<std::size_t>(pair - pairs_.data())]->contains(
            static_cast<double>(delay))) {
      surprise = 0;
    }
    const double count = first && !stalled ? 1.0 : 0.0;
    const double sign = pair->own && catches_up && surprise > 0 ? -1.0 : 1.0;
    pair->sums.add((surprise - std::max(pair->regime, 0.0) - drifts) * (sign * count));
    pair->regime += (surprise - pair->regime) * shareOf(regime_, event.stamp - last_stamp) * count;
    if (!pair->armed) {
      armPair(static_cast<std::size_t>(pair - pairs_.data()), first, surprise);
    }
  }
  for (std::uint32_t answer = type.answers_begin; answer < type.answers_end; ++answer) {
    ask(answer, event.stamp);
  }
  for (const std::uint32_t deadline : type.answered_deadlines) {
    deadlines_[deadline].requests = 0;
  }
  for (std::uint32_t deadline = type.deadlines_begin; deadline < type.deadlines_end; ++deadline) {
    Deadline& state = deadlines_[deadline];
    state.since = state.requests > 0 ? state.since : event.stamp;
    ++state.requests;
  }
  std::optional<std::int64_t> gap;
  if (last > 0) {
    gap = event.stamp - stamps[event.id];
    if (*gap > type.gone_after) {
      disarm(event.id);
    }
  } else {
    first_stamps_[event.id] = event.stamp;
  }
  stamps_[event.id] = event.stamp;
  numbers_[event.id] = ++number_;
  ++seen_[event.id];
  return gap;
}

bool Scorer::catchUp(const Event& event) {
  const double mean = types_[event.id].mean_gap;
  const double late = static_cast<double>(event.stamp - stamps_[event.id]) - mean;
  double& behind = behind_[event.id];
  const bool catches_up = late < 0 && -late < 2 * behind;
  behind = std::clamp(behind + late, 0.0, most_behind_ * mean);
  return catches_up;
}

void Scorer::noteStall(std::int64_t stamp) {
  const std::int64_t silence = stamp - last_stamp_;
  if (number_ > 0 && silence > longest_silence_ && silence <= longest_stall_ &&
      (stalled_at_ == 0 || stamp - stalled_at_ > between_stalls_)) {
    stalled_from_ = last_stamp_;
    stalled_at_ = stamp;
    stalled_until_ = stamp + silence;
  }
  last_stamp_ = std::max(last_stamp_, stamp);
}

void Scorer::armPair(std::size_t number, bool first, double surprise) {
  DelayPair& pair = pairs_[number];
  if (numbers_[pair.from] == 0) {
    pair.sums.values.setZero();
  } else if (pair.own && pairs_arming_[number].failures == 0) {
    pair.armed = true;  // the history of one event type has no phase that could be another one
  } else if (first) {
    pair.armed = arm(pairs_arming_[number], surprise, usual_surprise_);
  }
}

void Scorer::ask(std::size_t number, std::int64_t stamp) {
  Answer& answer = answers_[number];
  // A burst is one question.
  if (answer.asked && stamp - answer.asked_at < answer.usual_delay) {
    return;
  }
  const std::uint64_t came = seen_[answer.to] - answer.seen;
  const bool first = !answer.asked;
  answer.asked = true;
  answer.asked_at = stamp;
  answer.seen = seen_[answer.to];
  if (first || answer.seen == 0) {
    return;
  }
  // Two timers of one rate whose phases cross give 0, 2, 0, 2 answers: nothing was left out.
  double late = 0;
  if (came > 0) {
    late = std::min(static_cast<double>(came - 1), answer.owed);
    answer.owed -= late;
  } else {
    answer.owed += 1;
  }
  answer.sum += came > 0 ? answer.answered - late * answer.missed : answer.missed;
  answer.sum = std::max(std::min(answer.sum, answer.cap), 0.0);
  if (!answer.armed) {
    answer.armed =
        arm(answers_arming_[number], (came > 0 ? -late : 1) - answer.usual, kUsualMisses);
  }
}

void Scorer::capAt(const Limits& limits) {
  has_limits_ = true;
  const auto cap = [&](std::size_t track, double& of_sum) {
    if (limits.tracks[track] > 0) {  // never so where it is NaN
      of_sum = model_->tuning().most_of_limit * limits.tracks[track];
    }
  };
  for (std::size_t track = 0; track < model_->tracks().size(); ++track) {
    const Channel channel = model_->tracks()[track].channel;
    const std::size_t number = state_of_[track];
    if (channel == Channel::kDelay) {
      cap(track, pairs_[number].sums.caps[0]);
      cap(track + 1, pairs_[number].sums.caps[1]);
    } else if (channel == Channel::kAnswer) {
      cap(track, answers_[number].cap);
    }
  }
}

double Scorer::cap(std::size_t track) const {
  const std::size_t number = state_of_.at(track);
  switch (model_->tracks()[track].channel) {
    case Channel::kDelay:
      return pairs_[number].sums.caps[0];
    case Channel::kSlowDelay:
      return pairs_[number].sums.caps[1];
    case Channel::kAnswer:
      return answers_[number].cap;
    default:
      return kMostEvidence;
  }
}

void Scorer::disarm(EventId id) {
  for (const std::size_t track : tracks_of_[id]) {
    if (model_->tracks()[track].channel == Channel::kDelay) {
      disarmPair(state_of_[track]);
    } else {
      disarmAnswer(state_of_[track]);
    }
  }
}

void Scorer::disarmPair(std::size_t number) {
  pairs_[number].sums.values.setZero();
  pairs_[number].regime = 0;
  pairs_[number].armed = false;
  pairs_arming_[number] = {0, 0, pairs_arming_[number].failures};
  pairs_abnormal_since_[number] = 0;
}

void Scorer::disarmAnswer(std::size_t number) {
  Answer& answer = answers_[number];
  answer.sum = 0;
  answer.owed = 0;
  answer.asked = false;
  answer.armed = false;
  answers_arming_[number] = {0, 0, answers_arming_[number].failures};
  answers_abnormal_since_[number] = 0;
}

void Scorer::accept(std::int64_t end) {
  const double most_of_limit = model_->tuning().most_of_limit;
  const std::int64_t accept_after = toNanoseconds(model_->tuning().accept_after);
  for (std::size_t number = 0; number < pairs_.size(); ++number) {
    const Sums& sums = pairs_[number].sums;
    std::int64_t& since = pairs_abnormal_since_[number];
    if (!pairs_[number].armed || (sums.values * most_of_limit <= sums.caps).all()) {
      since = 0;
    } else if (since == 0) {
      since = end;
    } else if (end - since >= accept_after) {
      ++pairs_arming_[number].failures;
      disarmPair(number);
    }
  }
  for (std::size_t number = 0; number < answers_.size(); ++number) {
    const Answer& answer = answers_[number];
    std::int64_t& since = answers_abnormal_since_[number];
    if (!answer.armed || answer.sum * most_of_limit <= answer.cap) {
      since = 0;
    } else if (since == 0) {
      since = end;
    } else if (end - since >= accept_after && stamps_[answer.to] > since) {
      ++answers_arming_[number].failures;
      disarmAnswer(number);
    }
  }
}

const std::vector<double>& Scorer::closeWindow(std::int64_t end) {
  window_end_ = end;
  counts_.close();
  if (has_limits_) {
    accept(end);
  }
  // While all are silent, none is more so than the others.
  const std::int64_t silence = number_ > 0 ? end - last_stamp_ : 0;
  stall_ = silence > longest_silence_ && silence <= longest_stall_ ? silence : 0;
  const bool stalled = stall_ > 0 || (stalled_at_ > 0 && end < stalled_until_ + kRateSpan);
  const std::vector<Track>& tracks = model_->tracks();
  for (std::size_t track = 0; track < tracks.size(); ++track) {
    const auto& [channel, id, from] = tracks[track];
    const bool seen = numbers_[id] > 0;
    switch (channel) {
      case Channel::kOverdue:
        evidence_[track] = seen ? model_->overdue(id, age(id)) : 0;
        break;
      case Channel::kFewer:
      case Channel::kMore: {
        const double sign = channel == Channel::kMore ? 1 : -1;
        // A topic that began within the span has too few for that reason alone.
        const bool valid =
            counts_.full() && seen && end - first_stamps_[id] >= kRateSpan && !stalled;
        const double more = valid ? model_->rate(id, counts_.counts()[id]) : 0;
        evidence_[track] = std::max(sign * more, 0.0);
        break;
      }
      case Channel::kDelay:
      case Channel::kSlowDelay: {
        const DelayPair& pair = pairs_[state_of_[track]];
        evidence_[track] = pair.armed ? pair.sums.values[channel == Channel::kDelay ? 0 : 1] : 0;
        break;
      }
      case Channel::kAnswer: {
        const Answer& answer = answers_[state_of_[track]];
        evidence_[track] = answer.armed ? answer.sum : 0;
        break;
      }
      case Channel::kDeadline: {
        const Deadline& deadline = deadlines_[state_of_[track]];
        // Who was not heard yet may still be starting.
        const bool started = seen || end - start_ >= start_time_;
        evidence_[track] = deadline.requests == 0 || !started ? 0
                           : deadline.in_requests             ? deadline.requests
                                                              : toSeconds(end - deadline.since);
        break;
      }
    }
  }
  return evidence_;
}

std::optional<std::int64_t> Scorer::lastSeen(EventId id) const {
  return numbers_.at(id) > 0 ? std::optional<std::int64_t>(stamps_[id]) : std::nullopt;
}

Sum sumUp(const std::vector<double>& evidence, const Model& model, const Limits& limits) {
  Sum sum;
  std::vector<double> linked(model.components().size(), 0);
  for (std::size_t track = 0; track < evidence.size(); ++track) {
    const double share = evidence[track] / limits.tracks[track];
    const Channel channel = model.tracks()[track].channel;
    if (channel != Channel::kSlowDelay && share > sum.largest) {  // never so where it is NaN
      sum.largest = share;
    }
    if ((channel == Channel::kSlowDelay || channel == Channel::kAnswer) && share > 0) {
      double& of_component = linked[model.componentIndex(model.tracks()[track].to)];
      of_component =
          std::max(of_component, std::min((share - kLeastLinked) / (1 - kLeastLinked), 1.0));
    }
  }
  for (const double share : linked) {
    sum.linker += share;
  }
  return sum;
}

}  // namespace self_awareness::core::evidence
