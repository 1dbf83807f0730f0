#include "core/evidence/presence/strangers.h"

#include <algorithm>
#include <set>
#include <utility>

namespace self_awareness::core::evidence {
namespace {

const std::string kLog = "/rosout";
// As the default encoding tells lines apart: DEBUG, INFO, WARN.
const std::set<std::string> kBelowError{"[level=1]", "[level=2]", "[level=4]"};

const std::set<std::string> kForEverybody{"/rosout", "/diagnostics", "/tf", "/tf_static"};

}  // namespace

bool isForEverybody(const std::string& topic) {
  return kForEverybody.count(topic) > 0;
}

Suspect Strangers::unknownSuspect(EventId id, const Window& window) const {
  Suspect suspect;
  suspect.id = id;
  suspect.abnormal = true;
  const auto sent = sent_.find(id);
  suspect.onset = sent != sent_.end() ? sent->second.first : 0;
  const std::optional<Reason> news = news_.reasonOf(id);
  suspect.reason = news ? *news
                        : strangerIn(static_cast<std::size_t>(std::count_if(
                              window.events.begin(), window.events.end(),
                              [id](const ObservedEvent& other) { return other.event.id == id; })));
  return suspect;
}

void Strangers::addUnknown(const Window& window, std::int64_t since,
                           std::vector<Suspect>& suspects) const {
  for (const ObservedEvent& observed : window.events) {
    const EventId id = observed.event.id;
    if (observed.unknown && suspects.size() < kMostSuspects && !wasThere(id, since) &&
        std::none_of(suspects.begin(), suspects.end(),
                     [id](const Suspect& other) { return other.id == id; })) {
      suspects.push_back(unknownSuspect(id, window));
    }
  }
}

Strangers::Strangers(const Model& model, std::shared_ptr<const Vocabulary> heard,
                     std::shared_ptr<const SourceGraph> graph)
    : size_(model.size()),
      most_lines_(model.tuning().least_told),
      heard_(std::move(heard)),
      graph_(std::move(graph)),
      news_(model, heard_) {
  for (EventId id = 0; id < size_; ++id) {
    const std::string& topic = model.vocabulary().at(id).scope;
    sources_.insert(model.vocabulary().at(id).source);
    of_model_.emplace(model.vocabulary().at(id).source, topic);
    if (!isForEverybody(topic)) {
      known_[topic].push_back(id);
    }
  }
  // Who published nothing that was heard may log anew, too. At run time, the graph grows.
  for (const SourceGraph::Edge& edge : graph_->edges()) {
    sources_.insert(edge.publisher);
    sources_.insert(edge.subscriber);
  }
  for (const auto& [source, topic] : graph_->unheard()) {
    sources_.insert(source);
  }
  for (const auto& [subscription, recordings] : graph_->lasting()) {
    sources_.insert(subscription.first);
  }
}

bool Strangers::add(const Event& event, Accepted& accepted) {
  if (event.id < size_) {
    return false;
  }
  if (accepted.isAcceptedStranger(event.id)) {
    sent_.erase(event.id);
    return false;
  }
  const auto [known, is_new] = known_by_name_.try_emplace(event.id, false);
  if (is_new) {
    known->second = isKnownByName(event.id);
  }
  const bool is_news = !known->second && (!isUsualLine(event.id) || isFlood(event));
  if (is_news) {
    note(event);
  }
  return is_news;
}

void Strangers::note(const Event& event) {
  Sent& sent = sent_.try_emplace(event.id, Sent{event.stamp, event.stamp}).first->second;
  sent.first = event.stamp - sent.last > kOneCause ? event.stamp : sent.first;
  sent.last = event.stamp;
}

bool Strangers::wasThere(EventId id, std::int64_t stamp) const {
  const auto sent = sent_.find(id);
  return sent != sent_.end() && sent->second.first < stamp;
}

bool Strangers::isFlood(const Event& line) {
  Lines& lines = lines_.try_emplace(line.id, Lines{line.stamp, 0}).first->second;
  if (line.stamp - std::exchange(lines.last, line.stamp) > kRateSpan) {
    lines.number = 0;
  }
  return static_cast<double>(++lines.number) > most_lines_;
}

void Strangers::addList(const Event& event, Accepted& accepted) {
  if (event.id < size_ || !news_.isNewList(event.id) || accepted.isAcceptedStranger(event.id)) {
    sent_.erase(event.id);
  } else {
    note(event);
  }
}

bool Strangers::anyList(std::int64_t now) const {
  return std::any_of(sent_.begin(), sent_.end(), [&](const auto& sent) {
    return now - sent.second.last <= kRateSpan && heard_ && heard_->tellsList(sent.first);
  });
}

bool Strangers::isKnownByName(EventId id) const {
  if (!hasType(id)) {
    return false;
  }
  const SourceGraph::Publication publication(heard_->at(id).source, heard_->at(id).scope);
  return graph_->unheard().count(publication) > 0 && of_model_.count(publication) == 0;
}

bool Strangers::isUsualLine(EventId id) const {
  if (!hasType(id)) {
    return false;
  }
  const EventType& type = heard_->at(id);
  const std::size_t level = type.type.find('[');
  return type.scope == kLog && level != std::string::npos &&
         kBelowError.count(type.type.substr(level)) > 0 && sources_.count(type.source) > 0;
}

std::map<std::string, std::int64_t> Strangers::silences(std::int64_t now) const {
  std::map<std::string, std::int64_t> silences;
  for (const auto& [id, sent] : sent_) {
    if (hasType(id)) {
      std::int64_t& of_source =
          silences.try_emplace(heard_->at(id).source, now - sent.last).first->second;
      of_source = std::min(of_source, now - sent.last);
    }
  }
  return silences;
}

std::vector<Suspect> Strangers::suspects(const Window& window, const Scorer& scorer,
                                         const Moved& moved, std::int64_t since,
                                         const Suspect* unusual) const {
  std::vector<Suspect> suspects;
  for (const auto& [id, sent] : sent_) {
    const std::int64_t age = scorer.heard().windowEnd() - sent.last;
    if (age > kRateSpan || sent.first < since || moved.isPlaceOf(id) ||
        !(unusual == nullptr ? isStranger(id) : explains(id, *unusual))) {
      continue;
    }
    Suspect suspect = unknownSuspect(id, window);
    if (suspect.reason.value == 0) {
      suspect.reason = strangerBefore(toSeconds(age));
    }
    suspects.push_back(std::move(suspect));
  }
  return suspects;
}

bool Strangers::isStranger(EventId id) const {
  if (!hasType(id)) {
    return false;
  }
  if (heard_->tellsList(id)) {
    return true;
  }
  const EventType& type = heard_->at(id);
  const auto known = known_.find(type.scope);
  return known != known_.end() &&
         std::none_of(known->second.begin(), known->second.end(),
                      [&](EventId other) { return heard_->at(other).source == type.source; });
}

bool Strangers::explains(EventId id, const Suspect& unusual) const {
  if (!hasType(id) || heard_->tellsList(id)) {
    return false;
  }
  const EventType& type = heard_->at(id);
  const bool is_heard = graph_->empty()
                            ? unusual.reason.kind == Kind::kFast
                            : graph_->hears(unusual.component, type.source, type.scope);
  return isStranger(id) || (is_heard && !isAbsence(unusual.reason.kind) &&
                            type.source != unusual.component && !isForEverybody(type.scope));
}

}  // namespace self_awareness::core::evidence
