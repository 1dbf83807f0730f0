#include "self_awareness/core/evidence/channel/watched.h"

#include <set>
#include <stdexcept>
#include <string>
#include <tuple>

#include "core/evidence/channel/channels.h"

namespace self_awareness::core::evidence {
namespace {

/// The counts of one half, with the event types of both and the same ids.
Statistics withTypes(const Statistics& first, const Statistics& second, const Statistics& counts) {
  Statistics all;
  for (const Statistics* half : {&first, &second}) {
    for (const EventType& type : half->vocabulary().types()) {
      all.intern(type);
    }
  }
  all.merge(counts);
  return all;
}

/// @throw std::invalid_argument if one that is switched off does not exist
void checkChannels(const std::set<std::string>& without) {
  std::string names;
  for (const std::string& name : channelNames()) {
    names += (names.empty() ? "" : ", ") + name;
  }
  for (const std::string& name : without) {
    if (channelNamed(name) == nullptr) {
      throw std::invalid_argument("the method has no channel '" + name + "', only " + names);
    }
  }
}

std::vector<Statistics::Pair> pairsOf(const std::vector<Track>& tracks, std::size_t types) {
  std::vector<Statistics::Pair> pairs;
  for (EventId id = 0; id < types; ++id) {
    pairs.push_back({id, id});  // the gaps between two of a type
  }
  for (const Track& track : tracks) {
    pairs.push_back({track.from, track.to});
  }
  return pairs;
}

}  // namespace

Watched watch(const Statistics& first, const Statistics& second, const SourceGraph& graph,
              const Tuning& tuning) {
  if (first.vocabulary().types() != second.vocabulary().types()) {
    return watch(withTypes(first, second, first), withTypes(first, second, second), graph, tuning);
  }
  checkChannels(tuning.without);
  Statistics both = first;
  both.merge(second);
  const Gains gains({&first, &second}, tuning.fewest_gaps);
  const Relations relations(both, graph, tuning);
  const Choice choice{both, gains, relations, tuning};
  Watched watched;
  watched.tuning = tuning;
  for (const Channel* channel : channels()) {
    if (tuning.isOn(channel->name())) {
      const std::vector<Track> tracks = channel->watch(choice);
      watched.tracks.insert(watched.tracks.end(), tracks.begin(), tracks.end());
    }
  }
  const std::vector<Statistics::Pair> pairs = pairsOf(watched.tracks, first.size());
  watched.halves = {first.only(pairs), second.only(pairs)};
  return watched;
}

void checkTracks(const std::vector<Track>& tracks, std::size_t types) {
  std::set<std::tuple<const Channel*, EventId, EventId>> known;
  for (const Track& track : tracks) {
    if (track.channel == nullptr || track.to >= types || track.from >= types) {
      throw std::invalid_argument("it watches an event type that it does not have");
    }
    if (!known.emplace(track.channel, track.to, track.from).second) {
      throw std::invalid_argument("it watches the same twice");
    }
  }
}

}  // namespace self_awareness::core::evidence
