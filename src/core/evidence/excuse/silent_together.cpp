#include "core/evidence/excuse/silent_together.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kEver = std::numeric_limits<std::int64_t>::max();

/// Components with something in common: all, or those on one computer.
struct Group {
  std::vector<std::size_t> components;
  std::int64_t silence = kEver;  // of all of them, judged or not [ns]
};

}  // namespace

std::optional<std::int64_t> SilentTogether::closeWindow(const Unusual& window,
                                                        Judgement& judgement) {
  found_.reset();
  if (!window.isAbnormal()) {
    return std::nullopt;
  }
  const std::vector<Component> components = look(window);
  std::map<std::string, Group> hosts;
  Group all;
  for (std::size_t k = 0; k < components.size(); ++k) {
    for (Group* const group : {&all, &hosts[graph_->hostOf(model_->components()[k])]}) {
      group->components.push_back(k);
      group->silence = std::min(group->silence, components[k].silence.value_or(kEver));
    }
  }
  for (const auto& [source, silence] : window.strangers) {
    Group& host = hosts[graph_->hostOf(source)];
    host.silence = std::min(host.silence, silence);
  }
  hosts.erase("");  // those of whom it is not known
  Silent found;
  std::int64_t shortest = all.silence;
  std::vector<std::size_t> silent =
      together(all.components, all.silence, components, window.causes);
  if (silent.empty() && hosts.size() > 1) {
    shortest = kEver;
    for (const auto& [name, host] : hosts) {
      const std::vector<std::size_t> on_it =
          together(host.components, host.silence, components, window.causes);
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
  for (const std::size_t component : silent) {
    found.components.push_back(model_->components()[component]);
  }
  std::sort(found.components.begin(), found.components.end());
  found.since = window.heard().windowEnd() - shortest;
  found_ = found;
  judgement.silent = found;
  return found.since;
}

bool SilentTogether::explains(const Excess& excess, const Unusual& /*window*/) const {
  return found_->has(model_->components()[excess.component]) && excess.isTooLittle();
}

std::vector<std::size_t> SilentTogether::together(const std::vector<std::size_t>& group,
                                                  std::int64_t silence,
                                                  const std::vector<Component>& components,
                                                  const Causes& causes) const {
  std::vector<std::size_t> silent;
  std::size_t near = 0;
  for (const std::size_t k : group) {
    const Component& component = components[k];
    // Who fell silent long before the others did not do so with them, and stays what it was.
    if (!component.judged ||
        (component.silent && *component.silence - silence > component.longest)) {
      continue;
    }
    if (!component.silent) {
      return {};
    }
    silent.push_back(k);
    near += component.near ? 1 : 0;
  }
  // Where one of them is upstream of all others, it may have died alone.
  const auto isRoot = [&](std::size_t component) {
    return std::none_of(silent.begin(), silent.end(),
                        [&](std::size_t other) { return causes.isUpstream(other, component); });
  };
  // One that is silent says nothing of its computer.
  const bool is_enough = near > 1 && std::count_if(silent.begin(), silent.end(), isRoot) > 1;
  return is_enough ? silent : std::vector<std::size_t>();
}

std::vector<SilentTogether::Component> SilentTogether::look(const Unusual& window) const {
  // Who says one thing says nothing else at that moment, and is not silent.
  std::vector<Component> components(model_->components().size());
  for (EventId id = 0; id < model_->size(); ++id) {
    if (window.heard().hasSeen(id)) {
      Component& component = components[model_->componentIndex(id)];
      const std::int64_t silence = window.heard().listenedFor(id);
      component.silence = std::min(component.silence.value_or(silence), silence);
    }
  }
  for (EventId id = 0; id < model_->size(); ++id) {
    if (!std::isnan(window.limits_of_silence[id]) && window.heard().hasSeen(id)) {
      Component& component = components[model_->componentIndex(id)];
      const std::int64_t longest = model_->longestGap(id);
      component.longest = component.judged ? std::min(component.longest, longest) : longest;
      component.judged = true;
      component.silent = component.silent || model_->isRare(id, *component.silence);
    }
  }
  for (const Excess& excess : window.excesses) {
    if (excess.finding() == Finding::kSilent && excess.share > model_->tuning().near_limit) {
      components[excess.component].near = true;
    }
  }
  return components;
}

}  // namespace self_awareness::core::evidence
