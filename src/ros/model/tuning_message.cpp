#include "self_awareness/ros/model/tuning_message.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "check.h"
#include "self_awareness/core/evidence/channel/watched.h"

namespace self_awareness::ros1 {

namespace evidence = core::evidence;

self_awareness::Tuning toMessage(const evidence::Tuning& tuning) {
  self_awareness::Tuning message;
  for (const evidence::TuningNumber& number : evidence::tuningNumbers()) {
    message.names.push_back(number.name);
    message.values.push_back(tuning.*number.value);
  }
  message.without.assign(tuning.without.begin(), tuning.without.end());
  return message;
}

evidence::Tuning tuningOf(const self_awareness::Model& message) {
  evidence::Tuning tuning;
  const self_awareness::Tuning& given = message.tuning;
  check(given.names.size() == given.values.size(), "its tuning has names without numbers");
  check(std::set<std::string>(given.names.begin(), given.names.end()).size() == given.names.size(),
        "its tuning has a number twice");
  if (given.names.empty()) {  // format 1, where an event type was one of its own predecessors
    evidence::set(tuning, "predecessors", std::max(message.predecessors, 1U) - 1);
    evidence::set(tuning, "least_effect", message.least_effect / 1e9);
    evidence::set(tuning, "least_effect_of_period", message.least_effect_of_period);
  }
  // The limits of models that do not know it are in seconds wherever requests come in no series.
  evidence::set(tuning, "rare_misses", 1);
  for (const evidence::TuningNumber& number : evidence::tuningNumbers()) {
    const auto name = std::find(given.names.begin(), given.names.end(), number.name);
    if (name != given.names.end()) {
      evidence::set(tuning, number.name,
                    given.values[static_cast<std::size_t>(name - given.names.begin())]);
    }
  }
  const std::vector<std::string> channels = evidence::channelNames();
  for (const std::string& channel : given.without) {
    if (std::find(channels.begin(), channels.end(), channel) != channels.end()) {
      tuning.without.insert(channel);
    }
  }
  return tuning;
}

}  // namespace self_awareness::ros1
