#include "core/evidence/scorer.h"

#include <algorithm>
#include <utility>

#include "core/evidence/log_bins.h"

namespace self_awareness::core::evidence {
namespace {

// The drift of the slow sums: a small one lets weak evidence add up.
constexpr double kSlowDrift = 0.5;
// Independent timers keep one phase as long as they run, and have another one in every run:
// training may have met the same one by chance every time. So delays and answers count only after
// they have once been as in training, and again so when one of the event types comes back after it
// was gone (docs/method.md, section 3.7).
constexpr std::uint32_t kArmingEvents = 30;
constexpr double kUsualSurprise = 0.3;  // standard deviations above the mean of training
constexpr double kUsualMisses = 0.15;   // share of the gaps above that of training
constexpr std::int64_t kGoneGaps = 5;   // times the longest gap in training
constexpr double kMostEvidence = 200;   // while limits are not known
constexpr double kMostOfLimit = 1.5;    // in units of the limit
// Larger than any step of an answer track: taken from the step of a missed answer if it came.
// By so much the numbers of two events differ at least. An answer adds or takes less than 3 [nat].
constexpr double kMoreThanAnyStep = 1024;

}  // namespace

inline bool Scorer::arm(Arming& arming, double excess, double usual) {
  arming.excess += excess;
  if (++arming.events < kArmingEvents) {
    return false;
  }
  const bool armed = arming.excess <= usual * kArmingEvents;
  arming = {};
  return armed;
}

Scorer::Scorer(std::shared_ptr<const Model> model, std::int64_t window)
    : model_(std::move(model)), counts_(model_->size(), rateWindows(window)) {
  addTracks();
  restart();
}

void Scorer::addTracks() {
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
  Sums<2> none;
  none.caps.setConstant(kMostEvidence);
  for (EventId id = 0; id < model_->size(); ++id) {
    OfType type;
    type.gone_after = kGoneGaps * model_->longestGap(id);
    type.pairs_begin = static_cast<std::uint32_t>(pairs_.size());
    for (const std::size_t track : pairs[id]) {
      state_of_[track] = state_of_[track + 1] = pairs_.size();
      pairs_.push_back({tracks[track].from, false, model_->surprises(track).data(), none});
    }
    type.pairs_end = static_cast<std::uint32_t>(pairs_.size());
    type.blocks_begin = static_cast<std::uint32_t>(blocks_.size());
    addAnswers(id, answers[id]);
    type.blocks_end = static_cast<std::uint32_t>(blocks_.size());
    types_.push_back(type);
  }
  pairs_arming_.resize(pairs_.size());
}

void Scorer::addAnswers(EventId from, const std::vector<std::size_t>& tracks) {
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    const std::size_t answer = k % AnswerBlock::kAnswers;
    if (answer == 0) {
      blocks_.emplace_back().to.fill(from);
      miss_rates_.resize(blocks_.size() * AnswerBlock::kAnswers);
      answers_arming_.resize(blocks_.size() * AnswerBlock::kAnswers);
    }
    const std::size_t track = tracks[k];
    state_of_[track] = (blocks_.size() - 1) * AnswerBlock::kAnswers + answer;
    miss_rates_[state_of_[track]] = model_->missRate(track);
    AnswerBlock& block = blocks_.back();
    block.to[answer] = model_->tracks()[track].to;
    block.answered[static_cast<int>(answer)] = model_->answered(track);
    block.missed[static_cast<int>(answer)] = model_->missed(track);
    block.sums.caps[static_cast<int>(answer)] = kMostEvidence;
  }
}

void Scorer::restart() {
  stamps_.assign(model_->size(), 0);
  numbers_.assign(model_->size(), 0);
  number_ = 0;
  counts_.restart();
  evidence_.assign(model_->tracks().size(), 0);
  for (EventId id = 0; id < model_->size(); ++id) {
    disarm(id);
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
  const double* const numbers = numbers_.data();
  const double last = numbers[event.id];
  const Eigen::Array2d drifts(kDrift, kSlowDrift);
  // Pairs and answers with a type that was never seen are not armed: arming takes back what is
  // added to their sums here. So the many others need no check.
  DelayPair* const pairs_end = pairs_.data() + type.pairs_end;
  for (DelayPair* pair = pairs_.data() + type.pairs_begin; pair != pairs_end; ++pair) {
    // Only the first event after another counts: later ones, while the other pauses, would count
    // one pause many times. No branch, since the processor cannot predict which one is first.
    const bool first = numbers[pair->from] >= last;
    const std::int64_t delay = event.stamp - stamps[pair->from];
    const double surprise = pair->surprises[log_bins::bin(delay)];
    pair->sums.add((surprise - drifts) * (first ? 1.0 : 0.0));
    if (!pair->armed) {
      armPair(static_cast<std::size_t>(pair - pairs_.data()), first, surprise);
    }
  }
  std::optional<std::int64_t> gap;
  if (last > 0) {
    AnswerBlock* const blocks_end = blocks_.data() + type.blocks_end;
    for (AnswerBlock* block = blocks_.data() + type.blocks_begin; block != blocks_end; ++block) {
      const Eigen::Array4d others(numbers[block->to[0]], numbers[block->to[1]],
                                  numbers[block->to[2]], numbers[block->to[3]]);
      // One that came has a number so much larger, one that did not so much smaller, that these
      // are the steps of the one and of the other. Eigen does not vectorise a select.
      block->sums.add((last - others).max(block->answered).min(block->missed));
      if (block->unarmed != 0) {
        armAnswers(static_cast<std::size_t>(block - blocks_.data()), last);
      }
    }
    gap = event.stamp - stamps[event.id];
    if (*gap > type.gone_after) {
      disarm(event.id);
    }
  }
  stamps_[event.id] = event.stamp;
  number_ += kMoreThanAnyStep;
  numbers_[event.id] = number_;
  return gap;
}

void Scorer::armPair(std::size_t number, bool first, double surprise) {
  DelayPair& pair = pairs_[number];
  if (numbers_[pair.from] == 0) {
    pair.sums.values.setZero();
  } else if (first) {
    pair.armed = arm(pairs_arming_[number], surprise, kUsualSurprise);
  }
}

void Scorer::armAnswers(std::size_t block, double since) {
  AnswerBlock& answers = blocks_[block];
  for (std::size_t k = 0; k < AnswerBlock::kAnswers; ++k) {
    if (answers.armed(k)) {
      continue;
    }
    const double other = numbers_[answers.to[k]];
    const std::size_t number = block * AnswerBlock::kAnswers + k;
    if (other == 0) {
      answers.sums.values[static_cast<int>(k)] = 0;
    } else if (arm(answers_arming_[number], (other <= since ? 1 : 0) - miss_rates_[number],
                   kUsualMisses)) {
      answers.unarmed &= ~(1U << k);
    }
  }
}

void Scorer::capAt(const Limits& limits) {
  const auto cap = [&](std::size_t track, double& of_sum) {
    if (limits.tracks[track] > 0) {  // never so where it is NaN
      of_sum = kMostOfLimit * limits.tracks[track];
    }
  };
  for (std::size_t track = 0; track < model_->tracks().size(); ++track) {
    const Channel channel = model_->tracks()[track].channel;
    const std::size_t number = state_of_[track];
    if (channel == Channel::kDelay) {
      cap(track, pairs_[number].sums.caps[0]);
      cap(track + 1, pairs_[number].sums.caps[1]);
    } else if (channel == Channel::kAnswer) {
      cap(track, blocks_[number / AnswerBlock::kAnswers]
                     .sums.caps[static_cast<int>(number % AnswerBlock::kAnswers)]);
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
      return blocks_[number / AnswerBlock::kAnswers]
          .sums.caps[static_cast<int>(number % AnswerBlock::kAnswers)];
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
  pairs_[number].armed = false;
  pairs_arming_[number] = {};
}

void Scorer::disarmAnswer(std::size_t number) {
  AnswerBlock& block = blocks_[number / AnswerBlock::kAnswers];
  const std::size_t answer = number % AnswerBlock::kAnswers;
  block.sums.values[static_cast<int>(answer)] = 0;
  block.unarmed |= 1U << answer;
  answers_arming_[number] = {};
}

const std::vector<double>& Scorer::closeWindow(std::int64_t end) {
  window_end_ = end;
  counts_.close();
  const std::vector<Track>& tracks = model_->tracks();
  for (std::size_t track = 0; track < tracks.size(); ++track) {
    const auto& [channel, id, from] = tracks[track];
    const bool seen = numbers_[id] > 0;
    switch (channel) {
      case Channel::kOverdue:
        evidence_[track] = seen ? model_->overdue(id, end - stamps_[id]) : 0;
        break;
      case Channel::kFewer:
      case Channel::kMore: {
        const double sign = channel == Channel::kMore ? 1 : -1;
        const double more = counts_.full() && seen ? model_->rate(id, counts_.counts()[id]) : 0;
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
        const AnswerBlock& block = blocks_[state_of_[track] / AnswerBlock::kAnswers];
        const std::size_t answer = state_of_[track] % AnswerBlock::kAnswers;
        evidence_[track] = block.armed(answer) ? block.sums.values[static_cast<int>(answer)] : 0;
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

}  // namespace self_awareness::core::evidence
