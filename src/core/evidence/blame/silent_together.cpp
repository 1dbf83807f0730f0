#include "core/evidence/blame/silent_together.h"

#include <algorithm>
#include <cmath>
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
  Group all;
  std::map<std::string, Group> hosts;
  for (std::size_t k = 0; k < components.size(); ++k) {
    all.add(k, components[k]);
    hosts[graph_->hostOf(model_->components()[k])].add(k, components[k]);
  }
  for (const auto& [source, silence] : strangers) {
    Group& host = hosts[graph_->hostOf(source)];
    host.silence = std::min(host.silence, silence);
  }
  hosts.erase("");  // those of whom it is not known
  Silent found;
  std::int64_t shortest = all.silence;
  std::vector<std::size_t> silent = together(all, components);
  if (silent.empty() && hosts.size() > 1) {
    shortest = std::numeric_limits<std::int64_t>::max();
    for (const auto& [name, host] : hosts) {
      const std::vector<std::size_t> on_it = together(host, components);
      if (!on_it.empty()) {
        found.hosts.push_back(name);
        silent.insert(silent.end(), on_it.begin(), on_it.end());
        shortest = std::min(shortest, host.silence);
      }
    }
  }
  if (silent.empty()) {
    return std::nullopt;
  }
  for (const std::size_t k : silent) {
    found.components.push_back(model_->components()[k]);
  }
  std::sort(found.components.begin(), found.components.end());
  found.since = scorer.heard().windowEnd() - shortest;
  return found;
}

void SilentTogether::Group::add(std::size_t index, const Component& component) {
  if (component.seen) {
    silence = std::min(silence, component.silence);
  }
  if (component.judged) {
    judged.push_back(index);
  }
}

std::vector<std::size_t> SilentTogether::together(const Group& group,
                                                  const std::vector<Component>& components) const {
  std::vector<std::size_t> silent;
  std::size_t near = 0;
  for (const std::size_t k : group.judged) {
    const Component& component = components[k];
    // Who fell silent long before the others did not do so with them, and stays what it was.
    if (component.silent && component.silence - group.silence > component.longest) {
      continue;
    }
    if (!component.silent) {
      return {};
    }
    silent.push_back(k);
    near += component.near ? 1 : 0;
  }
  return near >= kFewest ? silent : std::vector<std::size_t>();
}

std::vector<SilentTogether::Component> SilentTogether::look(const std::vector<double>& shares,
                                                            const Limits& limits,
                                                            const Scorer& scorer) const {
  // Who says one thing says nothing else at that moment, and is not silent.
  std::vector<Component> components(model_->components().size());
  for (EventId id = 0; id < model_->size(); ++id) {
    if (scorer.heard().hasSeen(id)) {
      Component& component = components[model_->componentIndex(id)];
      const std::int64_t silence = scorer.heard().listenedFor(id);
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

}  // namespace self_awareness::core::evidence
