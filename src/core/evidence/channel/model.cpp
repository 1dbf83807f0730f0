#include "self_awareness/core/evidence/channel/model.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <stdexcept>
#include <utility>

#include "core/evidence/channel/channels.h"
#include "core/evidence/channel/topic_values.h"
#include "core/evidence/count/log_bins.h"
#include "core/evidence/watch/heads_and_tails.h"

namespace self_awareness::core::evidence {
namespace {

Statistics sum(const Halves& halves) {
  Statistics both = halves[0];
  both.merge(halves[1]);
  return both;
}

}  // namespace

Model::Model(const Watched& watched, Learned learned)
    : statistics_(sum(watched.halves)), tracks_(watched.tracks), tuning_(watched.tuning) {
  if (size() == 0) {
    throw std::invalid_argument("a model needs at least one event");
  }
  checkTracks(tracks_, size());
  tuning_.validate();
  if (learned != Learned::kBoth) {
    half_ = watched.halves.at(learned == Learned::kFirst ? 0 : 1);
  }
  numberComponents();
  findOtherValues();
  for (EventId id = 0; id < size(); ++id) {
    gaps_.emplace_back(this->learned().type(id), this->learned().delays(id, id));
  }
  for (const Track& track : tracks_) {
    findings_.push_back(track.channel->finding());
  }
  letChannelsExpect(watched.halves);
}

Model::~Model() = default;

void Model::numberComponents() {
  std::map<std::string, std::size_t> numbers;
  for (const EventType& type : vocabulary().types()) {
    const std::string& name = componentOf(type.source, type.scope);
    const auto [number, is_new] = numbers.emplace(name, components_.size());
    if (is_new) {
      components_.push_back(name);
    }
    component_of_.push_back(number->second);
  }
}

void Model::findOtherValues() {
  in_place_of_.resize(size());
  for (const auto& [type, ids] : valuesByTopic(vocabulary())) {
    for (const EventId id : ids) {
      if (pauses(id)) {
        std::copy_if(ids.begin(), ids.end(), std::back_inserter(in_place_of_[id]),
                     [id = id](EventId other) { return other != id; });
      }
    }
  }
}

void Model::letChannelsExpect(const Halves& halves) {
  expectation_of_.resize(tracks_.size());
  for (const Channel* channel : channels()) {
    std::vector<std::size_t> its_tracks;
    for (std::size_t track = 0; track < tracks_.size(); ++track) {
      if (tracks_[track].channel == channel) {
        its_tracks.push_back(track);
        expectation_of_[track] = expectations_.size();
      }
    }
    if (!its_tracks.empty()) {
      expectations_.push_back(channel->expect(*this, halves, std::move(its_tracks)));
    }
  }
}

double Model::logSurvival(EventId id, std::int64_t age) const {
  return static_cast<double>(learned().type(id).gaps) < tuning_.fewest_gaps
             ? 0
             : gaps_[id].logSurvival(age);
}

bool Model::isRare(EventId id, std::int64_t silence) const {
  return logSurvival(id, silence) < std::log(tuning().rare);
}

std::int64_t Model::longestSilence() const {
  std::int64_t longest = 0;
  for (const Statistics::Recording& recording : statistics_.recordings()) {
    longest = std::max(longest, recording.longest_silence);
  }
  return longest;
}

std::int64_t Model::longestSilence(EventId id) const {
  return std::max(longestGap(id), HeadsAndTails(statistics_, id, tuning_).longest());
}

std::int64_t Model::longestStall() const {
  std::int64_t longest = 0;
  for (const Statistics::Recording& recording : statistics_.recordings()) {
    longest = std::max(longest, recording.longest_stall);
  }
  return longest;
}

double Model::usualDelay(EventId from, EventId to, double share) const {
  const DelayHistogram& delays = learned().delays(from, to);
  // How long the longest delay between two types was is not known: the last bin ends where it
  // begins.
  auto longest = static_cast<double>(log_bins::lowerEdge(log_bins::kBins - 1));
  const Statistics::Type& type = learned().type(to);
  if (from == to && type.gaps > 0) {
    const double wanted = share * static_cast<double>(delays.total());
    const auto longer = static_cast<std::size_t>(static_cast<double>(type.gaps) - wanted);
    if (longer < type.longest_gaps.size()) {
      return static_cast<double>(type.longest_gaps[longer]);
    }
    longest = static_cast<double>(type.longestGap());
  }
  return delays.quantile(share, longest);
}

double Model::shareOfLosses() const {
  AttributeCounts all;
  for (const Track& track : tracks_) {
    const AttributeCounts& counts = learned().type(track.to).attributes;
    if (track.channel->kind() == Kind::kLossy && counts.shareOfLosses() <= tuning_.rare) {
      all.merge(counts);
    }
  }
  return all.shareOfLosses();
}

double Model::leastLimit(std::size_t track) const {
  return expectation(track).leastLimit(track);
}

}  // namespace self_awareness::core::evidence
