#include "core/evidence/blame/silent_together.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace self_awareness::core::evidence {
namespace {

// One that is silent says nothing of its computer.
constexpr std::size_t kFewest = 2;

}  // namespace

SilentTogether::SilentTogether(std::shared_ptr<const Model> model,
                               std::shared_ptr<const SourceGraph> graph)
    : model_(std::move(model)), graph_(std::move(graph)) {}

std::optional<Silent> SilentTogether::find(
    const std::vector<double>& shares, const Limits& limits, const Scorer& scorer,
    const std::map<std::string, std::int64_t>& strangers) const {
  const std::vector<Component> components = look(shares, limits, scorer);
  std::size_t judged = 0;
  std::size_t silent = 0;
  for (const Component& component : components) {
    judged += component.judged ? 1 : 0;
    silent += component.silent ? 1 : 0;
  }
  if (silent < kFewest) {
    return std::nullopt;
  }
  Silent found;
  const bool all = silent == judged;
  if (!all) {
    found.hosts = silentHosts(components, strangers);
  }
  std::int64_t shortest = std::numeric_limits<std::int64_t>::max();
  for (std::size_t k = 0; k < components.size(); ++k) {
    const std::string& name = model_->components()[k];
    if (components[k].silent && (all || std::binary_search(found.hosts.begin(), found.hosts.end(),
                                                           graph_->hostOf(name)))) {
      found.components.push_back(name);
      shortest = std::min(shortest, components[k].silence);
    }
  }
  if (found.components.empty()) {
    return std::nullopt;
  }
  std::sort(found.components.begin(), found.components.end());
  found.since = scorer.heard().windowEnd() - shortest;
  return found;
}

std::vector<SilentTogether::Component> SilentTogether::look(const std::vector<double>& shares,
                                                            const Limits& limits,
                                                            const Scorer& scorer) const {
  // Who says one thing says nothing else at that moment, and is not silent.
  std::vector<Component> components(model_->components().size());
  for (EventId id = 0; id < model_->size(); ++id) {
    if (scorer.heard().hasSeen(id)) {
      Component& component = components[model_->componentIndex(id)];
      const std::int64_t silence = scorer.heard().silence(id);
      component.silence = component.seen ? std::min(component.silence, silence) : silence;
      component.seen = true;
    }
  }
  const double rare = std::log(model_->tuning().rare_silence);
  for (std::size_t track = 0; track < model_->tracks().size(); ++track) {
    const EventId id = model_->tracks()[track].to;
    if (model_->finding(track) != Finding::kSilent || std::isnan(limits.tracks[track]) ||
        !scorer.heard().hasSeen(id)) {
      continue;
    }
    Component& component = components[model_->componentIndex(id)];
    const std::int64_t longest = model_->longestGap(id);
    component.longest = component.judged ? std::min(component.longest, longest) : longest;
    component.judged = true;
    component.silent = component.silent || model_->logSurvival(id, component.silence) < rare;
    component.near = component.near || shares[track] > model_->tuning().near_limit;
  }
  return components;
}

std::vector<std::string> SilentTogether::silentHosts(
    const std::vector<Component>& components,
    const std::map<std::string, std::int64_t>& strangers) const {
  struct Host {
    std::int64_t silence = std::numeric_limits<std::int64_t>::max();  // of all on it [ns]
    std::size_t near = 0;                                             // components
    bool silent = true;
  };
  std::map<std::string, Host> hosts;
  for (const auto& [source, silence] : strangers) {
    Host& host = hosts[graph_->hostOf(source)];
    host.silence = std::min(host.silence, silence);
  }
  for (std::size_t k = 0; k < components.size(); ++k) {
    if (components[k].seen) {
      Host& host = hosts[graph_->hostOf(model_->components()[k])];
      host.silence = std::min(host.silence, components[k].silence);
    }
  }
  for (std::size_t k = 0; k < components.size(); ++k) {
    if (components[k].judged) {
      Host& host = hosts[graph_->hostOf(model_->components()[k])];
      host.near += components[k].near ? 1 : 0;
      // Who fell silent long before the others did not do so with them.
      host.silent = host.silent && components[k].silent &&
                    components[k].silence - host.silence <= components[k].longest;
    }
  }
  hosts.erase("");  // those of whom it is not known
  std::vector<std::string> silent;
  for (const auto& [name, host] : hosts) {
    if (host.silent && host.near >= kFewest) {
      silent.push_back(name);
    }
  }
  return hosts.size() > 1 ? silent : std::vector<std::string>();
}

}  // namespace self_awareness::core::evidence
