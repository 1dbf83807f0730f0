#include "model_upgrade.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "check.h"
#include "self_awareness/Track.h"
#include "self_awareness/core/evidence/channel/track.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/ros/stable_name.h"

namespace self_awareness::ros1 {
namespace {

/// Removes from a table with a column for each track those of the tracks that do not stay.
template <typename Value>
void removeColumns(const std::vector<bool>& stays, std::vector<Value>& table) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < table.size(); ++k) {
    if (stays[k % stays.size()]) {
      if (kept != k) {  // a string that is moved to itself is empty
        table[kept] = std::move(table[k]);
      }
      ++kept;
    }
  }
  table.resize(kept);
}

/// Name of the channel of a track, also of one that went with its rule.
std::string nameInFormat1(const self_awareness::Track& track) {
  static const std::map<std::uint8_t, std::string> kNames{{0, "overdue"}, {1, "fewer"},
                                                          {2, "more"},    {4, "slow delays"},
                                                          {5, "answers"}, {6, "deadlines"}};
  constexpr std::uint8_t kDelays = 3;
  if (track.channel == kDelays) {
    return track.to_id == track.from_id ? "own gaps" : "pairs";
  }
  const auto name = kNames.find(track.channel);
  return name == kNames.end() ? "channel " + std::to_string(track.channel) : name->second;
}

}  // namespace

std::string resolveNames(self_awareness::Model& message) {
  const auto resolve = [](std::string& name) { name = resolvedName(name); };
  std::set<core::EventType> types;
  for (self_awareness::EventType& type : message.event_types) {
    const std::string scope = type.scope;
    resolve(type.source);
    resolve(type.scope);
    if (!types.insert({type.source, type.scope, type.type}).second && scope != type.scope) {
      return type.scope;
    }
  }
  for (self_awareness::GraphEdge& edge : message.graph) {
    resolve(edge.publisher);
    resolve(edge.topic);
    resolve(edge.subscriber);
  }
  for (self_awareness::NodeHost& placed : message.hosts) {
    resolve(placed.node);
  }
  for (self_awareness::Subscription& lasting : message.subscriptions) {
    resolve(lasting.node);
    resolve(lasting.topic);
  }
  for (self_awareness::TopicNodes& unheard : message.unheard) {
    resolve(unheard.topic);
    std::for_each(unheard.publishers.begin(), unheard.publishers.end(), resolve);
  }
  return "";
}

std::set<std::string> upgrade(self_awareness::Model& message, std::uint32_t format) {
  if (format == 1) {
    for (self_awareness::Track& track : message.tracks) {
      track.name = nameInFormat1(track);
    }
  }
  // The format says nothing of the channels that the writer's method had: what one of them watches
  // stands beside the others, and says nothing of them.
  const std::vector<std::string> channels = core::evidence::channelNames();
  return removeOtherTracks(message, {channels.begin(), channels.end()});
}

std::set<std::string> removeOtherTracks(self_awareness::Model& message,
                                        const std::set<std::string>& channels) {
  std::set<std::string> removed;
  std::vector<bool> stays;
  for (const self_awareness::Track& track : message.tracks) {
    stays.push_back(channels.count(track.name) > 0);
    if (!stays.back()) {
      removed.insert(track.name);
    }
  }
  if (removed.empty()) {
    return removed;
  }
  const std::size_t tracks = stays.size();
  removeColumns(stays, message.tracks);
  for (self_awareness::RecordingFindings& findings : message.findings) {
    check(findings.evidence.size() == findings.part_windows.size() * tracks &&
              findings.said.size() == tracks,
          "its findings do not fit its tracks");
    removeColumns(stays, findings.evidence);
    removeColumns(stays, findings.said);
  }
  for (self_awareness::EvidenceCalibration& calibration : message.evidence_calibration) {
    check(calibration.limits.size() == tracks, "its limits are not those of its evidence");
    check(calibration.relations.empty() || calibration.relations.size() == tracks,
          "its relations are not those of its evidence");
    removeColumns(stays, calibration.limits);
    removeColumns(stays, calibration.relations);
  }
  return removed;
}

}  // namespace self_awareness::ros1
