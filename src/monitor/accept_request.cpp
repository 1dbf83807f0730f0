#include "accept_request.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

#include "core/verdict/name_list.h"
#include "ros/text.h"
#include "self_awareness/core/verdict/incident.h"

namespace self_awareness {
namespace {

/// Names by which somebody may be called.
struct Names {
  std::set<std::string> components;
  std::set<std::string> topics;
};

Names namesIn(const core::Vocabulary& vocabulary, const core::Acceptances& accepted) {
  Names names;
  for (const core::EventType& type : vocabulary.types()) {
    names.components.insert(core::componentOf(type.source, type.scope));
    names.topics.insert(type.scope);
  }
  for (const core::Acceptance& each : accepted.list()) {
    names.components.insert(each.component);
    names.topics.insert(each.topic);
  }
  return names;
}

/// @throw std::invalid_argument if it is no name, and no begin of one and a `*`
void checkName(const std::string& name, const char* field, bool known) {
  const auto wrong = [&](const char* why) {
    throw std::invalid_argument(std::string(field) + ": " + why);
  };
  if (name.size() > ros1::kLongestName || !ros1::isPrintable(name)) {
    wrong("not a name: too long, or not printable");
  }
  if (name.empty() || known) {
    return;
  }
  if (name.front() != '/') {
    wrong("a name begins with a /");
  }
  if (name.find('*') < name.size() - 1) {
    wrong("a * stands for the rest of a name, so it is at its end");
  }
}

std::optional<core::Kind> kindIn(const std::string& name) {
  if (name.empty()) {
    return std::nullopt;
  }
  const std::optional<core::Kind> kind = core::kindOf(name);
  if (!kind) {
    throw std::invalid_argument("kind: " + ros1::printable(name, ros1::kLongestName) +
                                " is not a kind; ~alarm shows the kind of what stands");
  }
  if (core::Acceptance{"", "", kind}.extent() == core::Acceptance::Extent::kNothing) {
    throw std::invalid_argument("kind: " + name +
                                " is nothing that a component does; name a component, and the "
                                "kind of what it may do");
  }
  return kind;
}

/// What is named, by the names that events have.
core::Acceptance ofNames(const std::string& component, const std::string& topic,
                         const std::string& kind, const Names& names,
                         const ros1::Encoder& encoder) {
  const bool component_known = names.components.count(component) > 0;
  const bool topic_known = names.topics.count(topic) > 0;
  checkName(component, "component", component_known);
  checkName(topic, "topic", topic_known);
  core::Acceptance acceptance{component, topic, kindIn(kind)};
  const auto isOne = [](const std::string& name) { return !name.empty() && name.back() != '*'; };
  if (isOne(component) && !component_known) {
    acceptance.component =
        encoder.tellsSources() ? encoder.sourceOf(component) : encoder.scopeOf(component);
  }
  if (isOne(topic) && !topic_known) {
    acceptance.topic = encoder.scopeOf(topic);
  }
  return acceptance;
}

/// What a suspect does, on its topic.
std::vector<core::Acceptance> ofSuspect(const core::Suspect& suspect,
                                        const core::Vocabulary& vocabulary) {
  std::vector<std::string> topics = suspect.reason.topics;
  if (topics.empty()) {
    topics.push_back(vocabulary.at(suspect.id).scope);
  }
  std::vector<core::Acceptance> all;
  for (const std::string& topic : topics) {
    all.push_back({suspect.component, topic, suspect.reason.kind});
  }
  return all;
}

/// That these are off together. @param components in order
core::Acceptance ofMode(std::vector<std::string> components) {
  return {"", "", core::Kind::kNewMode, std::move(components)};
}

/// What an alarm or a suspicion holds against components: of all that are abnormal by themselves,
/// unless they share something that is to blame for the others.
std::vector<core::Acceptance> ofAlarm(const core::Alarm& alarm,
                                      const core::Vocabulary& vocabulary) {
  if (alarm.kind == core::Kind::kNewMode && alarm.silent) {
    return {ofMode(alarm.silent->components)};
  }
  if (alarm.culprit.empty()) {
    throw std::invalid_argument("nobody is to blame for it (" + core::toString(alarm.kind) +
                                "); name a component that may do so, and the kind of what it "
                                "does: \"{component: /NAME, kind: silent}\"");
  }
  const bool shared = alarm.busy || alarm.silent;
  std::vector<core::Acceptance> all;
  for (const std::vector<core::Suspect>& suspects : {alarm.suspects, alarm.later}) {
    for (const core::Suspect& suspect : suspects) {
      if (((suspect.abnormal && !shared) || suspect.component == alarm.culprit) &&
          suspect.id < vocabulary.size()) {
        const std::vector<core::Acceptance> of_suspect = ofSuspect(suspect, vocabulary);
        all.insert(all.end(), of_suspect.begin(), of_suspect.end());
      }
    }
  }
  if (all.empty()) {  // it is of before the start
    all.push_back({alarm.culprit, "", alarm.kind});
  }
  return all;
}

/// What an incident holds against its component, and those who failed in the same way at once.
/// @throw std::invalid_argument if nobody is to blame, or it is a mode of unknown components
std::vector<core::Acceptance> ofIncident(const self_awareness::Incident& incident) {
  if (incident.kind == core::toString(core::Kind::kNewMode)) {
    if (incident.together.empty() || incident.together.size() == core::Incident::kMostNamed) {
      throw std::invalid_argument(
          "not all components that were off are known any more; accept the mode while it stands, "
          "by its alarm");
    }
    return {ofMode(incident.together)};
  }
  if (incident.component.empty()) {
    throw std::invalid_argument("nobody is to blame for it (" + incident.kind +
                                "); name a component, and the kind of what it may do");
  }
  std::vector<std::string> names{incident.component};
  const std::optional<core::Kind> kind = kindIn(incident.kind);
  if (kind && core::isSilence(*kind)) {  // who is there fell silent
    names.insert(names.end(), incident.together.begin(), incident.together.end());
  }
  std::vector<core::Acceptance> all;
  for (const std::string& name : names) {
    all.push_back({name, "", kind});
  }
  return all;
}

std::vector<core::Acceptance> ofIncident(std::uint64_t id,
                                         const self_awareness::Incidents& incidents) {
  const auto& known = incidents.incidents;
  const auto found =
      std::find_if(known.begin(), known.end(), [&](const auto& each) { return each.id == id; });
  if (found == known.end()) {
    throw std::invalid_argument("incident: there is none of the id " + std::to_string(id) +
                                " on ~incidents");
  }
  return ofIncident(*found);
}

std::vector<core::Acceptance> ofWhatStands(std::uint64_t id, const Acceptable& acceptable) {
  if (!acceptable.alarm || acceptable.alarm->id != id) {
    throw std::invalid_argument("alarm: " + std::to_string(id) + " does not stand any more");
  }
  return ofAlarm(*acceptable.alarm, acceptable.vocabulary);
}

bool isAccepted(const core::Acceptance& one, const core::Acceptances& accepted) {
  return one.together.empty()
             ? accepted.covers(one.component, one.topic, one.kind.value_or(core::Kind::kSilent))
             : accepted.coversMode(one.together);
}

/// A call as it is typed, and what it accepts. Empty: there is nothing in it that is not accepted.
std::string offer(const std::string& call, const std::vector<core::Acceptance>& all,
                  const core::Acceptances& accepted) {
  const bool known = std::all_of(all.begin(), all.end(), [&](const core::Acceptance& one) {
    return isAccepted(one, accepted);
  });
  return known ? "" : "\"{" + call + "}\" for " + inWordsOf(all);
}

/// What the last incidents hold against components, but for that of the alarm that stands.
std::vector<std::string> offersOfIncidents(const Acceptable& acceptable,
                                           const core::Acceptances& accepted) {
  std::vector<std::string> offers;
  const auto& known = acceptable.incidents.incidents;
  for (auto each = known.rbegin(); each != known.rend(); ++each) {
    if (acceptable.alarm && acceptable.alarm->id == each->last) {
      continue;
    }
    try {
      offers.push_back(
          offer("incident: " + std::to_string(each->id), ofIncident(*each), accepted));
    } catch (const std::invalid_argument&) {
      continue;  // nobody is to blame for it
    }
  }
  return offers;
}

bool namesNothing(const Accept::Request& request) {
  return request.component.empty() && request.topic.empty() && request.kind.empty();
}

WantedAcceptances ofNames(const Accept::Request& request, const Acceptable& acceptable,
                          const core::Acceptances& accepted) {
  if (request.more.size() > core::Acceptances::kMost) {
    throw std::invalid_argument("more: there are more than " +
                                std::to_string(core::Acceptances::kMost));
  }
  std::vector<self_awareness::Acceptance> all = request.more;
  if (!namesNothing(request)) {
    self_awareness::Acceptance& first = *all.emplace(all.begin());
    first.component = request.component;
    first.topic = request.topic;
    first.kind = request.kind;
  }
  const Names names =
      namesIn(acceptable.vocabulary, request.undo != 0U ? accepted : core::Acceptances());
  WantedAcceptances result;
  for (const self_awareness::Acceptance& each : all) {
    try {
      if (each.component.empty() && each.topic.empty() &&
          (request.undo == 0U || each.kind.empty())) {
        throw std::invalid_argument(
            "name a component or a topic: a kind alone would be that of all components");
      }
      result.asked.push_back(
          ofNames(each.component, each.topic, each.kind, names, acceptable.encoder));
      if (request.undo == 0U && result.asked.back().kind == core::Kind::kNewMode) {
        result.asked.pop_back();
        throw std::invalid_argument(
            "kind: a new mode is of several components; accept it while it stands, or the "
            "incident");
      }
    } catch (const std::invalid_argument& error) {
      const std::string& name = each.component.empty() ? each.topic : each.component;
      result.refused.push_back(
          (all.size() > 1 ? ros1::printable(name, ros1::kLongestName) + ": " : "") + error.what());
    }
  }
  if (result.asked.empty()) {
    throw std::invalid_argument(result.refused.front());
  }
  return result;
}

}  // namespace

bool asksWhat(const Accept::Request& request) {
  return namesNothing(request) && request.more.empty() && request.alarm == 0 &&
         request.incident == 0;
}

std::string offerOf(const Accept::Request& request, const Acceptable& acceptable,
                    const core::Acceptances& accepted) {
  std::vector<std::string> offers;
  if (request.undo != 0U) {
    return accepted.list().empty()
               ? "nothing is accepted"
               : "name what is to be judged again: " + inWordsOf(accepted.list());
  }
  if (acceptable.alarm) {
    const std::string id = std::to_string(acceptable.alarm->id);
    try {
      offers.push_back(
          offer("alarm: " + id, ofAlarm(*acceptable.alarm, acceptable.vocabulary), accepted));
    } catch (const std::invalid_argument& error) {
      offers.push_back("alarm " + id + ": " + error.what());
    }
  }
  for (const auto& [id, events] : acceptable.unknown) {
    const core::EventType& type = acceptable.vocabulary.at(id);
    offers.push_back("\"{component: " + core::componentOf(type.source, type.scope) +
                     ", topic: " + type.scope + ", kind: stranger}\" for " +
                     std::to_string(events) + " messages of it");
  }
  const std::vector<std::string> of_incidents = offersOfIncidents(acceptable, accepted);
  offers.insert(offers.end(), of_incidents.begin(), of_incidents.end());
  offers.erase(std::remove(offers.begin(), offers.end(), ""), offers.end());
  return offers.empty() ? "nothing stands, and nobody is new; name a component or a topic"
                        : "nothing is accepted, as nothing is named. Give " +
                              core::listed(offers, kMostNamed);
}

WantedAcceptances requestOf(const Accept::Request& request, const Acceptable& acceptable,
                            const core::Acceptances& accepted) {
  const bool names = !namesNothing(request) || !request.more.empty();
  const int ways = static_cast<int>(names) + static_cast<int>(request.incident != 0) +
                   static_cast<int>(request.alarm != 0);
  if (ways > 1) {
    throw std::invalid_argument(
        "give an alarm or an incident alone, without component, topic, kind and more");
  }
  if (names) {
    return ofNames(request, acceptable, accepted);
  }
  return {request.incident != 0 ? ofIncident(request.incident, acceptable.incidents)
                                : ofWhatStands(request.alarm, acceptable),
          {}};
}

std::string inWordsOf(const core::Acceptance& acceptance) {
  std::string words = acceptance.component;
  for (const std::string& each : acceptance.together) {
    words += (words.empty() ? "" : " ") + each;
  }
  if (!acceptance.topic.empty() && acceptance.topic != acceptance.component) {
    words += (words.empty() ? "" : " on ") + acceptance.topic;
  }
  return words + (acceptance.kind ? " (" + core::toString(*acceptance.kind) + ")" : "");
}

std::string inWordsOf(const std::vector<core::Acceptance>& all) {
  std::vector<std::string> words;
  for (const core::Acceptance& each : all) {
    words.push_back(inWordsOf(each));
  }
  return core::listed(words, kMostNamed);
}

bool concerns(const core::Acceptance& acceptance, const core::EventType& type) {
  const std::string& component = core::componentOf(type.source, type.scope);
  if (acceptance.kind == core::Kind::kUnsubscribed && !acceptance.component.empty()) {
    // Its topic is none that its component sends.
    return core::matchesPattern(acceptance.component, component);
  }
  return acceptance.isAbout(component, type.scope);
}

bool isKnown(const core::Acceptance& acceptance, const core::Vocabulary& vocabulary) {
  return std::any_of(vocabulary.types().begin(), vocabulary.types().end(),
                     [&](const core::EventType& type) { return concerns(acceptance, type); });
}

}  // namespace self_awareness
