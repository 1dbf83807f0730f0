#include "self_awareness/core/evidence_scorer.h"

#include <algorithm>
#include <utility>

namespace self_awareness::core {
namespace {

// What usual delays take from the sum, in standard deviations: much finds strong evidence without
// false alarms, little lets weak evidence add up.
constexpr double kDrift = 1;
constexpr double kSlowDrift = 0.5;
// Independent timers keep one phase as long as they run, and have another one in every run:
// training may have met the same one by chance every time. So delays and answers count from when
// they have once been as in training, and anew when one of the event types comes back after it was
// gone.
constexpr std::uint32_t kArmingEvents = 30;
constexpr double kUsualSurprise = 0.3;  // standard deviations above the mean of training
constexpr double kUsualMisses = 0.15;   // share of the gaps above that of training
constexpr std::int64_t kGoneGaps = 5;   // times the longest gap in training
constexpr double kMostEvidence = 200;   // while limits are not known
constexpr double kMostOfLimit = 1.5;    // in units of the limit

}  // namespace

inline bool EvidenceScorer::arm(Arming& arming, double excess, double usual) {
  arming.excess += excess;
  if (++arming.events < kArmingEvents) {
    return false;
  }
  const bool armed = arming.excess <= usual * kArmingEvents;
  arming = {};
  return armed;
}

EvidenceScorer::EvidenceScorer(std::shared_ptr<const EvidenceModel> model, std::int64_t window)
    : model_(std::move(model)), counts_(model_->size(), rateWindows(window)) {
  addTracks();
  restart();
}

void EvidenceScorer::addTracks() {
  const std::vector<Track>& tracks = model_->tracks();
  std::vector<std::vector<std::size_t>> pairs(model_->size());    // tracks by `to`
  std::vector<std::vector<std::size_t>> answers(model_->size());  // tracks by `from`
  tracks_of_.resize(model_->size());
  for (std::size_t track = 0; track < tracks.size(); ++track) {
    const auto& [channel, to, from] = tracks[track];
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
  const Sum none{0, kMostEvidence};
  for (EventId id = 0; id < model_->size(); ++id) {
    OfType type;
    type.gone_after = kGoneGaps * model_->longestGap(id);
    type.pairs_begin = static_cast<std::uint32_t>(pairs_.size());
    for (const std::size_t track : pairs[id]) {
      state_of_[track] = state_of_[track + 1] = pairs_.size();
      pairs_.push_back(
          {tracks[track].from, false, 0, model_->surprises(track).data(), none, none});
    }
    type.pairs_end = static_cast<std::uint32_t>(pairs_.size());
    type.answers_begin = static_cast<std::uint32_t>(answers_.size());
    for (const std::size_t track : answers[id]) {
      state_of_[track] = answers_.size();
      answers_.push_back(
          {tracks[track].to, false, {model_->answered(track), model_->missed(track)}, none});
      miss_rates_.push_back(model_->missRate(track));
    }
    type.answers_end = static_cast<std::uint32_t>(answers_.size());
    types_.push_back(type);
  }
  pairs_arming_.resize(pairs_.size());
  answers_arming_.resize(answers_.size());
}

void EvidenceScorer::restart() {
  last_seen_.assign(model_->size(), {});
  number_ = 0;
  counts_.restart();
  evidence_.assign(model_->tracks().size(), 0);
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    pairs_[k].last_delay = 0;
    disarmPair(k);
  }
  for (std::size_t k = 0; k < answers_.size(); ++k) {
    disarmAnswer(k);
  }
}

std::optional<std::int64_t> EvidenceScorer::add(const Event& event) {
  if (event.id >= types_.size()) {
    return std::nullopt;
  }
  const OfType& type = types_[event.id];
  counts_.add(event.id);
  Seen& last = last_seen_[event.id];
  for (std::size_t k = type.pairs_begin; k < type.pairs_end; ++k) {
    DelayPair& pair = pairs_[k];
    const Seen& from = last_seen_[pair.from];
    // Only the first event after another answers it: those that follow while the other pauses
    // would count one pause many times. Which one that is cannot be predicted, thus no branch.
    const bool first = from.number > 0 && from.number >= last.number;
    const std::int64_t delay = event.stamp - from.stamp;
    const double surprise = pair.surprises[log_bins::bin(delay)];
    pair.last_delay = first ? delay : pair.last_delay;
    pair.fast.add(first * (surprise - kDrift));
    pair.slow.add(first * (surprise - kSlowDrift));
    if (!pair.armed && first) {
      pair.armed = arm(pairs_arming_[k], surprise, kUsualSurprise);
    }
  }
  std::optional<std::int64_t> gap;
  if (last.number > 0) {
    for (std::size_t k = type.answers_begin; k < type.answers_end; ++k) {
      Answer& answer = answers_[k];
      const std::uint64_t number = last_seen_[answer.to].number;
      if (number == 0) {
        continue;
      }
      const std::size_t missed = number <= last.number ? 1 : 0;
      answer.sum.add(answer.steps[missed]);
      if (!answer.armed) {
        answer.armed =
            arm(answers_arming_[k], static_cast<double>(missed) - miss_rates_[k], kUsualMisses);
      }
    }
    gap = event.stamp - last.stamp;
    if (*gap > type.gone_after) {
      disarm(event.id);
    }
  }
  last = Seen{event.stamp, ++number_};
  return gap;
}

void EvidenceScorer::capAt(const EvidenceLimits& limits) {
  const auto cap = [&](std::size_t track, Sum& sum) {
    if (limits.tracks[track] > 0) {  // never so where it is NaN
      sum.cap = kMostOfLimit * limits.tracks[track];
    }
  };
  for (std::size_t track = 0; track < model_->tracks().size(); ++track) {
    const Channel channel = model_->tracks()[track].channel;
    if (channel == Channel::kDelay) {
      cap(track, pairs_[state_of_[track]].fast);
      cap(track + 1, pairs_[state_of_[track]].slow);
    } else if (channel == Channel::kAnswer) {
      cap(track, answers_[state_of_[track]].sum);
    }
  }
}

void EvidenceScorer::disarm(EventId id) {
  for (const std::size_t track : tracks_of_[id]) {
    if (model_->tracks()[track].channel == Channel::kDelay) {
      disarmPair(state_of_[track]);
    } else {
      disarmAnswer(state_of_[track]);
    }
  }
}

void EvidenceScorer::disarmPair(std::size_t number) {
  pairs_[number].fast.value = pairs_[number].slow.value = 0;
  pairs_[number].armed = false;
  pairs_arming_[number] = {};
}

void EvidenceScorer::disarmAnswer(std::size_t number) {
  answers_[number].sum.value = 0;
  answers_[number].armed = false;
  answers_arming_[number] = {};
}

const std::vector<double>& EvidenceScorer::closeWindow(std::int64_t end) {
  window_end_ = end;
  counts_.close();
  const std::vector<Track>& tracks = model_->tracks();
  for (std::size_t track = 0; track < tracks.size(); ++track) {
    const auto& [channel, id, from] = tracks[track];
    const Seen& last = last_seen_[id];
    switch (channel) {
      case Channel::kOverdue:
        evidence_[track] = last.number > 0 ? model_->overdue(id, end - last.stamp) : 0;
        break;
      case Channel::kFewer:
      case Channel::kMore: {
        const double sign = channel == Channel::kMore ? 1 : -1;
        const double more =
            counts_.full() && last.number > 0 ? model_->rate(id, counts_.counts()[id]) : 0;
        evidence_[track] = std::max(sign * more, 0.0);
        break;
      }
      case Channel::kDelay:
      case Channel::kSlowDelay: {
        const DelayPair& pair = pairs_[state_of_[track]];
        const Sum& sum = channel == Channel::kDelay ? pair.fast : pair.slow;
        evidence_[track] = pair.armed ? sum.value : 0;
        break;
      }
      case Channel::kAnswer: {
        const Answer& answer = answers_[state_of_[track]];
        evidence_[track] = answer.armed ? answer.sum.value : 0;
        break;
      }
    }
  }
  return evidence_;
}

std::optional<std::int64_t> EvidenceScorer::lastSeen(EventId id) const {
  const Seen& last = last_seen_.at(id);
  return last.number > 0 ? std::optional<std::int64_t>(last.stamp) : std::nullopt;
}

EvidenceSum sumUp(const std::vector<double>& evidence, const EvidenceModel& model,
                  const EvidenceLimits& limits) {
  EvidenceSum sum;
  std::vector<double> linked(model.size(), 0);
  for (std::size_t track = 0; track < evidence.size(); ++track) {
    const double share = evidence[track] / limits.tracks[track];
    const Channel channel = model.tracks()[track].channel;
    if (channel != Channel::kSlowDelay && share > sum.largest) {  // never so where it is NaN
      sum.largest = share;
    }
    if ((channel == Channel::kSlowDelay || channel == Channel::kAnswer) && share > 0) {
      double& of_type = linked[model.tracks()[track].to];
      of_type = std::max(of_type, std::min(share, 1.0));
    }
  }
  for (const double share : linked) {
    sum.linker += share;
  }
  return sum;
}

}  // namespace self_awareness::core
