#include "core/evidence/excuse/stopped_together.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>

namespace self_awareness::core::evidence {
namespace {

// One that is silent says nothing of its computer.
constexpr std::size_t kFewest = 2;
constexpr std::int64_t kEver = std::numeric_limits<std::int64_t>::max();

/// Whether evidence says that something has not come, or too seldom.
bool isOfAbsence(Finding finding) {
  return finding == Finding::kFewer || isAbsence(finding);
}

/// When the last of them was heard [ns].
std::int64_t lastOf(const std::vector<EventId>& ids, const Heard& heard) {
  std::int64_t last = 0;
  for (const EventId id : ids) {
    last = std::max(last, heard.stamps()[id]);
  }
  return last;
}

}  // namespace

StoppedTogether::StoppedTogether(std::shared_ptr<const Model> model,
                                 std::shared_ptr<const Upstream> upstream,
                                 std::shared_ptr<const SourceGraph> graph)
    : model_(std::move(model)),
      upstream_(std::move(upstream)),
      graph_(std::move(graph)),
      excused_until_(model_->size(), 0) {}

StoppedTogether::Found StoppedTogether::excuse(
    std::vector<Excess>& excesses, const Limits& limits, const Scorer& scorer,
    const std::map<std::string, std::int64_t>& strangers, const std::vector<bool>& may_be_silent) {
  Found found;
  if (std::none_of(excesses.begin(), excesses.end(),
                   [](const Excess& excess) { return excess.share > 1; })) {
    return found;
  }
  Window window{limitsOfSilence(limits), scorer.heard(), excesses, {}};
  found.silent = everything(window, strangers);
  if (found.silent) {
    for (Excess& excess : excesses) {
      // Who fell silent before is none of them; what is left of a sum is no finding.
      if (found.silent->has(model_->components()[excess.component]) &&
          (isOfAbsence(model_->finding(excess.track)) || excess.share <= 1) &&
          excess.excuse == Excuse::kNone) {
        excess.excuse = Excuse::kAllSilent;
      }
    }
  }
  if (upstream_->empty()) {
    return found;
  }
  window.missed = missedBy(window.heard, excesses);
  const Ids silent = this->silent(window, may_be_silent);
  std::set<EventId> stopped = this->stopped(silent, window);
  Ids ids(stopped.begin(), stopped.end());
  const std::vector<std::string> names = namesOf(componentsOf(ids));
  if (!stopped.empty() && !accepted_.coversMode(names)) {
    cover(ids, Excuse::kNewMode, kEver, window);
    if (found.silent) {  // what was there before all fell silent
      return found;
    }
    Silent& mode = found.silent.emplace();
    mode.others_go_on = true;
    mode.components = names;
    mode.since = lastOf(ids, window.heard);
    return found;
  }
  for (const Acceptance& mode : accepted_.list()) {
    addOff(mode, silent, window.heard, stopped);
  }
  if (!stopped.empty()) {
    ids.assign(stopped.begin(), stopped.end());
    cover(ids, Excuse::kAccepted,
          lastOf(ids, window.heard) + toNanoseconds(model_->tuning().start_time), window);
    found.mode = namesOf(componentsOf(ids));
  }
  return found;
}

void StoppedTogether::accept(const Acceptances& accepted) {
  accepted_ = {};
  for (const Acceptance& each : accepted.list()) {
    if (each.extent() == Acceptance::Extent::kMode) {
      accepted_.add(each);
    }
  }
}

void StoppedTogether::restart() {
  std::fill(excused_until_.begin(), excused_until_.end(), 0);
}

std::vector<double> StoppedTogether::limitsOfSilence(const Limits& limits) const {
  std::vector<double> of_silence(model_->size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t track = 0; track < model_->tracks().size(); ++track) {
    if (model_->finding(track) == Finding::kSilent) {
      of_silence[model_->tracks()[track].to] = limits.tracks[track];
    }
  }
  return of_silence;
}

bool StoppedTogether::isRare(EventId id, std::int64_t silence) const {
  return model_->logSurvival(id, silence) < std::log(model_->tuning().rare_silence);
}

std::set<std::size_t> StoppedTogether::componentsOf(const Ids& ids) const {
  std::set<std::size_t> components;
  for (const EventId id : ids) {
    components.insert(model_->componentIndex(id));
  }
  return components;
}

std::vector<std::string> StoppedTogether::namesOf(const std::set<std::size_t>& components) const {
  std::vector<std::string> names;
  names.reserve(components.size());
  for (const std::size_t component : components) {
    names.push_back(model_->components()[component]);
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::optional<Silent> StoppedTogether::everything(
    const Window& window, const std::map<std::string, std::int64_t>& strangers) const {
  const std::vector<Component> components = look(window);
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
    shortest = kEver;
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
  found.components = namesOf({silent.begin(), silent.end()});
  found.since = window.heard.windowEnd() - shortest;
  return found;
}

void StoppedTogether::Group::add(std::size_t index, const Component& component) {
  if (component.seen) {
    silence = std::min(silence, component.silence);
  }
  if (component.judged) {
    judged.push_back(index);
  }
}

std::vector<std::size_t> StoppedTogether::together(
    const Group& group, const std::vector<Component>& components) const {
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
  // Where one of them is upstream of all others, it may have died alone.
  const auto isRoot = [&](std::size_t component) {
    return std::none_of(silent.begin(), silent.end(), [&](std::size_t other) {
      return upstream_->isUpstream(other, component);
    });
  };
  const bool is_enough = near >= kFewest && static_cast<std::size_t>(std::count_if(
                                                silent.begin(), silent.end(), isRoot)) >= kFewest;
  return is_enough ? silent : std::vector<std::size_t>();
}

std::vector<StoppedTogether::Component> StoppedTogether::look(const Window& window) const {
  // Who says one thing says nothing else at that moment, and is not silent.
  std::vector<Component> components(model_->components().size());
  for (EventId id = 0; id < model_->size(); ++id) {
    if (window.heard.hasSeen(id)) {
      Component& component = components[model_->componentIndex(id)];
      const std::int64_t silence = window.heard.listenedFor(id);
      component.silence = component.seen ? std::min(component.silence, silence) : silence;
      component.seen = true;
    }
  }
  for (EventId id = 0; id < model_->size(); ++id) {
    if (std::isnan(window.limits[id]) || !window.heard.hasSeen(id)) {
      continue;
    }
    Component& component = components[model_->componentIndex(id)];
    const std::int64_t longest = model_->longestGap(id);
    component.longest = component.judged ? std::min(component.longest, longest) : longest;
    component.judged = true;
    component.silent = component.silent || isRare(id, component.silence);
  }
  for (const Excess& excess : window.excesses) {
    if (model_->finding(excess.track) == Finding::kSilent &&
        excess.share > model_->tuning().near_limit) {
      components[excess.component].near = true;
    }
  }
  return components;
}

StoppedTogether::Ids StoppedTogether::silent(const Window& window,
                                             const std::vector<bool>& may_be_silent) const {
  std::vector<bool> owes = may_be_silent;
  for (const Excess& excess : window.excesses) {
    if (model_->finding(excess.track) == Finding::kUnanswered && excess.share > 1) {
      owes[trackOf(excess).to] = true;
    }
  }
  Ids silent;
  for (EventId id = 0; id < model_->size(); ++id) {
    if (!std::isnan(window.limits[id]) && !owes[id] && window.heard.hasSeen(id) &&
        isRare(id, window.heard.listenedFor(id))) {
      silent.push_back(id);
    }
  }
  return silent;
}

std::set<EventId> StoppedTogether::stopped(const Ids& silent, const Window& window) {
  const std::int64_t now = window.heard.windowEnd();
  std::set<EventId> stopped;
  for (Ids& group : groups(silent, window)) {
    // Who stopped with many did not stop with few, too.
    group.erase(std::remove_if(group.begin(), group.end(),
                               [&](EventId id) { return stopped.count(id) > 0; }),
                group.end());
    if (areUnrelated(group, window.heard) && othersGoOn(group, window.heard)) {
      stopped.insert(group.begin(), group.end());
    }
  }
  // They do not come back all at once.
  for (const EventId id : silent) {
    if (stopped.count(id) > 0) {
      excused_until_[id] = now + kRateSpan + static_cast<std::int64_t>(model_->meanGap(id));
    } else if (now < excused_until_[id]) {
      stopped.insert(id);
    }
  }
  return stopped;
}

std::vector<StoppedTogether::Ids> StoppedTogether::groups(const Ids& silent,
                                                          const Window& window) const {
  std::set<Ids> groups;  // most stop with the same ones
  std::set<EventId> seen;
  for (const Excess& excess : window.excesses) {
    const EventId id = trackOf(excess).to;
    const Finding finding = model_->finding(excess.track);
    if (excess.share > 1 && window.heard.hasSeen(id) &&
        (finding == Finding::kSilent || finding == Finding::kAbsent) && seen.insert(id).second) {
      groups.insert(stoppedWith(id, silent, window));
    }
  }
  std::vector<Ids> ordered(groups.begin(), groups.end());
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const Ids& a, const Ids& b) { return a.size() > b.size(); });
  return ordered;
}

StoppedTogether::Ids StoppedTogether::stoppedWith(EventId id, const Ids& silent,
                                                  const Window& window) const {
  const auto stamps = window.heard.stamps();
  Ids together;
  for (const EventId other : silent) {
    const EventId first = stamps[other] < stamps[id] ? other : id;
    const std::int64_t apart = std::abs(stamps[other] - stamps[id]);
    if (apart <= kRateSpan + static_cast<std::int64_t>(model_->meanGap(first)) &&
        !wasMissed(first, stamps[first] + apart, window)) {
      together.push_back(other);
    }
  }
  const std::int64_t last = lastOf(together, window.heard);
  together.erase(std::remove_if(together.begin(), together.end(),
                                [&](EventId other) { return wasMissed(other, last, window); }),
                 together.end());
  return together;
}

std::vector<std::int64_t> StoppedTogether::missedBy(const Heard& heard,
                                                    const std::vector<Excess>& excesses) const {
  std::vector<std::int64_t> missed(model_->size(), kNotYet);
  for (const Excess& excess : excesses) {
    if (excess.abnormal == kNotYet || !isAbsence(model_->finding(excess.track))) {
      continue;
    }
    const std::int64_t usual = kRateSpan + model_->longestGap(trackOf(excess).to);
    for (EventId id = 0; id < model_->size(); ++id) {
      const std::int64_t last = heard.stamps()[id];
      const std::size_t component = model_->componentIndex(id);
      // Who fell silent long before it was heard last does not wait for it.
      if (heard.hasSeen(id) && last < excess.abnormal && last - excess.onset <= usual &&
          (component == excess.component || upstream_->isUpstream(component, excess.component))) {
        missed[id] = std::min(missed[id], excess.abnormal);
      }
    }
  }
  return missed;
}

bool StoppedTogether::wasMissed(EventId id, std::int64_t stamp, const Window& window) const {
  const std::int64_t silence = stamp - window.heard.stamps()[id];
  return silence > 0 &&
         (window.missed[id] <= stamp || model_->overdue(id, silence) > window.limits[id]);
}

bool StoppedTogether::areUnrelated(const Ids& ids, const Heard& heard) const {
  const std::set<std::size_t> components = componentsOf(ids);
  if (static_cast<double>(components.size()) < model_->tuning().fewest_busy) {
    return false;
  }
  // Judged or not, who was not heard since, but as lately as is usual, may have died.
  const std::int64_t stop = lastOf(ids, heard);
  std::vector<bool> as_usual(model_->components().size(), false);
  std::vector<bool> since(model_->components().size(), false);
  for (EventId id = 0; id < model_->size(); ++id) {
    if (const std::optional<std::int64_t> last = heard.lastSeen(id)) {
      const std::size_t component = model_->componentIndex(id);
      since[component] = since[component] || *last > stop;
      as_usual[component] =
          as_usual[component] || stop - *last <= kRateSpan + model_->longestGap(id);
    }
  }
  const auto isRoot = [&](std::size_t component) {
    for (std::size_t other = 0; other < since.size(); ++other) {
      const bool may_have_died = components.count(other) > 0 || (as_usual[other] && !since[other]);
      if (may_have_died && upstream_->isUpstream(other, component)) {
        return false;
      }
    }
    return true;
  };
  return static_cast<double>(std::count_if(components.begin(), components.end(), isRoot)) >=
         model_->tuning().fewest_busy;
}

bool StoppedTogether::othersGoOn(const Ids& ids, const Heard& heard) const {
  const std::int64_t last = *std::max_element(heard.stamps(), heard.stamps() + model_->size());
  return last - lastOf(ids, heard) > heard.windowEnd() - last;
}

void StoppedTogether::addOff(const Acceptance& mode, const Ids& silent, const Heard& heard,
                             std::set<EventId>& off) const {
  const auto isOfIt = [&](EventId id) {
    return std::binary_search(mode.together.begin(), mode.together.end(), model_->component(id));
  };
  Ids seen;
  for (EventId id = 0; id < model_->size(); ++id) {
    if (heard.hasSeen(id) && isOfIt(id)) {
      seen.push_back(id);
    }
  }
  if (static_cast<double>(componentsOf(seen).size()) < model_->tuning().fewest_busy) {
    return;
  }
  const std::int64_t latest = lastOf(seen, heard);
  for (const EventId id : silent) {
    const auto others_longer = static_cast<double>(latest - heard.stamps()[id]);
    if (isOfIt(id) && others_longer <= static_cast<double>(heard.silence(id)) / 2 &&
        others_longer <= static_cast<double>(kRateSpan) + model_->meanGap(id)) {
      off.insert(id);
    }
  }
}

void StoppedTogether::cover(const Ids& stopped, Excuse excuse, std::int64_t until,
                            const Window& window) const {
  std::map<std::size_t, std::int64_t> lasts;  // of their components [ns]
  for (const EventId id : stopped) {
    std::int64_t& last = lasts[model_->componentIndex(id)];
    last = std::max(last, window.heard.stamps()[id]);
  }
  const auto waitsForThem = [&](EventId id) {
    const std::int64_t heard = window.heard.stamps()[id];
    return heard <= until && std::any_of(lasts.begin(), lasts.end(), [&](const auto& last) {
             return upstream_->isUpstream(last.first, model_->componentIndex(id)) &&
                    last.second - heard <= kRateSpan + model_->longestGap(id) &&
                    !wasMissed(id, last.second, window);
           });
  };
  for (Excess& excess : window.excesses) {
    const EventId id = trackOf(excess).to;
    if (excess.excuse == Excuse::kNone &&
        (std::binary_search(stopped.begin(), stopped.end(), id) ||
         (isOfAbsence(model_->finding(excess.track)) &&
          model_->finding(excess.track) != Finding::kUnanswered && waitsForThem(id)))) {
      excess.excuse = excuse;
    }
  }
}

}  // namespace self_awareness::core::evidence
