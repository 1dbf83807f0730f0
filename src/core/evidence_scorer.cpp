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

void EvidenceScorer::Arming::add(double excess, double usual) {
  if (armed_) {
    return;
  }
  sum_ += excess;
  if (++events_ == kArmingEvents) {
    armed_ = sum_ <= usual * kArmingEvents;
    events_ = 0;
    sum_ = 0;
  }
}

EvidenceScorer::EvidenceScorer(std::shared_ptr<const EvidenceModel> model, std::int64_t window)
    : model_(std::move(model)),
      delay_tracks_(model_->size()),
      answer_tracks_(model_->size()),
      counts_(model_->size(), rateWindows(window)),
      caps_(model_->tracks().size(), kMostEvidence) {
  const std::vector<Track>& tracks = model_->tracks();
  for (std::size_t track = 0; track < tracks.size(); ++track) {
    if (tracks[track].channel == Channel::kDelay || tracks[track].channel == Channel::kSlowDelay) {
      delay_tracks_[tracks[track].to].push_back(track);
    } else if (tracks[track].channel == Channel::kAnswer) {
      answer_tracks_[tracks[track].from].push_back(track);
    }
  }
  restart();
}

void EvidenceScorer::restart() {
  last_seen_.assign(model_->size(), std::nullopt);
  number_ = 0;
  counts_.restart();
  evidence_.assign(model_->tracks().size(), 0);
  sums_.assign(model_->tracks().size(), 0);
  arming_.assign(model_->tracks().size(), {});
  last_delays_.assign(model_->tracks().size(), 0);
}

std::optional<std::int64_t> EvidenceScorer::add(const Event& event) {
  if (!model_->knows(event.id)) {
    return std::nullopt;
  }
  const std::vector<Track>& tracks = model_->tracks();
  counts_.add(event.id);
  std::optional<Seen>& last = last_seen_[event.id];
  for (const std::size_t track : delay_tracks_[event.id]) {
    const std::optional<Seen>& from = last_seen_[tracks[track].from];
    // Only the first event after another answers it: those that follow while the other pauses
    // would count one pause many times.
    if (from && (!last || from->number >= last->number)) {
      const double drift = tracks[track].channel == Channel::kDelay ? kDrift : kSlowDrift;
      last_delays_[track] = event.stamp - from->stamp;
      const double step = model_->surprise(track, last_delays_[track]) - drift;
      sums_[track] = std::clamp(sums_[track] + step, 0.0, caps_[track]);
      arming_[track].add(step + drift, kUsualSurprise);
    }
  }
  for (const std::size_t track : answer_tracks_[event.id]) {
    const std::optional<Seen>& to = last_seen_[tracks[track].to];
    if (last && to) {
      const bool missed = to->number <= last->number;
      const double step = missed ? model_->missed(track) : model_->answered(track);
      arming_[track].add((missed ? 1 : 0) - model_->missRate(track), kUsualMisses);
      sums_[track] = std::clamp(sums_[track] + step, 0.0, caps_[track]);
    }
  }
  std::optional<std::int64_t> gap;
  if (last) {
    gap = event.stamp - last->stamp;
    if (*gap > kGoneGaps * model_->longestGap(event.id)) {
      disarm(event.id);
    }
  }
  last = Seen{event.stamp, ++number_};
  return gap;
}

void EvidenceScorer::capAt(const EvidenceLimits& limits) {
  for (std::size_t track = 0; track < caps_.size(); ++track) {
    if (limits.tracks[track] > 0) {  // never so where it is NaN
      caps_[track] = kMostOfLimit * limits.tracks[track];
    }
  }
}

void EvidenceScorer::disarm(EventId id) {
  const std::vector<Track>& tracks = model_->tracks();
  for (std::size_t track = 0; track < tracks.size(); ++track) {
    if (tracks[track].to == id || tracks[track].from == id) {
      arming_[track] = {};
      sums_[track] = 0;
    }
  }
}

const std::vector<double>& EvidenceScorer::closeWindow(std::int64_t end) {
  window_end_ = end;
  counts_.close();
  const std::vector<Track>& tracks = model_->tracks();
  for (std::size_t track = 0; track < tracks.size(); ++track) {
    const EventId id = tracks[track].to;
    if (tracks[track].channel == Channel::kOverdue) {
      evidence_[track] = last_seen_[id] ? model_->overdue(id, end - last_seen_[id]->stamp) : 0;
    } else if (tracks[track].channel == Channel::kFewer ||
               tracks[track].channel == Channel::kMore) {
      const double sign = tracks[track].channel == Channel::kMore ? 1 : -1;
      const double more =
          counts_.full() && last_seen_[id] ? model_->rate(id, counts_.counts()[id]) : 0;
      evidence_[track] = std::max(sign * more, 0.0);
    } else {
      evidence_[track] = arming_[track].armed() ? sums_[track] : 0;
    }
  }
  return evidence_;
}

std::optional<std::int64_t> EvidenceScorer::lastSeen(EventId id) const {
  const std::optional<Seen>& last = last_seen_.at(id);
  return last ? std::optional<std::int64_t>(last->stamp) : std::nullopt;
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
