#include "core/evidence/presence/moved.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/evidence/presence/news.h"
#include "core/evidence/presence/strangers.h"

namespace self_awareness::core::evidence {
namespace {

// A rate is known after so long [ns].
constexpr std::int64_t kLongEnough = 2 * kRateSpan;

}  // namespace

Moved::Moved(std::shared_ptr<const Model> model, std::shared_ptr<const Vocabulary> heard,
             std::vector<bool> expected)
    : model_(std::move(model)),
      heard_(std::move(heard)),
      expected_(std::move(expected)),
      moved_(model_->size(), false),
      has_other_value_(model_->size(), false) {
  for (EventId id = 0; id < model_->size(); ++id) {
    const EventType& type = model_->vocabulary().at(id);
    if (!type.source.empty() && model_->vocabulary().isMessage(id)) {
      known_[{type.scope, type.type}].push_back(id);
      of_source_[type.source].push_back(id);
      if (const std::optional<EventType> any = withoutValue(type)) {
        valued_[*any].push_back(id);
      }
    }
  }
}

void Moved::add(const Event& event) {
  if (model_->knows(event.id) || !heard_ || event.id >= heard_->size()) {
    return;
  }
  addValue(event);
  if (known_.count({typeOf(event.id).scope, typeOf(event.id).type}) == 0) {
    return;
  }
  Sent& sent = sent_.try_emplace(event.id, Sent{event.stamp, 0, 0, false}).first->second;
  sent.last = event.stamp;
  ++sent.events;
}

void Moved::addValue(const Event& event) {
  const std::optional<EventType> any = withoutValue(typeOf(event.id));
  const auto valued = any ? valued_.find(*any) : valued_.end();
  if (valued != valued_.end()) {
    for (const EventId known : valued->second) {
      other_values_[known] = event.stamp;
    }
  }
}

void Moved::restart() {
  other_values_.clear();
  sent_.clear();
  places_.clear();
  others_.clear();
  pairs_.clear();
  takers_.clear();
  moved_.assign(moved_.size(), false);
  has_other_value_.assign(moved_.size(), false);
}

std::optional<bool> Moved::fits(const Sent& sent, EventId known) const {
  const std::int64_t time = now_ - sent.first;
  const double expected = static_cast<double>(time) / model_->meanGap(known);
  if (time < kLongEnough || expected < model_->tuning().several) {
    return std::nullopt;
  }
  const auto events = static_cast<double>(sent.events);
  const double most = model_->tuning().margin;  // times as often, or as seldom
  return expected < most * events && events < most * expected;
}

bool Moved::standsFor(const std::string& source, const std::string& known,
                      const Heard& heard) const {
  if (pairs_.count({source, known}) > 0) {
    return true;
  }
  const auto isAlone = [&](EventId id) {
    return isForEverybody(model_->vocabulary().at(id).scope) && !heard.hasSeen(id);
  };
  const std::vector<EventId>& all = of_source_.at(known);
  return of_source_.count(source) == 0 && std::all_of(all.begin(), all.end(), isAlone) &&
         std::none_of(pairs_.begin(), pairs_.end(),
                      [&](const auto& pair) { return pair.first == source; });
}

void Moved::findPlaces(const Heard& heard, bool for_everybody) {
  for (const auto& [id, sent] : sent_) {
    const EventType& type = typeOf(id);
    if (isForEverybody(type.scope) != for_everybody) {
      continue;
    }
    for (const EventId known : known_.at({type.scope, type.type})) {
      const std::string& source = model_->vocabulary().at(known).source;
      const auto place = places_.find(known);
      if (heard.hasSeen(known) || source == type.source || others_.count({id, known}) > 0 ||
          (place != places_.end() && place->second.taker != id) ||
          (for_everybody && !standsFor(type.source, source, heard))) {
        continue;
      }
      const bool firm = place != places_.end() && place->second.firm;
      const std::optional<bool> same = firm ? true : fits(sent, known);
      if (same.value_or(true)) {
        places_[known] = {id, same.has_value()};
        pairs_.insert({type.source, source});
      } else {
        places_.erase(known);
        others_.insert({id, known});
      }
    }
  }
}

void Moved::closeWindow(const Heard& heard, Accepted& accepted) {
  now_ = heard.windowEnd();
  if (sent_.empty() && other_values_.empty()) {
    return;
  }
  for (auto& [id, sent] : sent_) {
    sent.accepted = accepted.isAcceptedStranger(id);
  }
  for (auto place = places_.begin(); place != places_.end();) {
    place = heard.hasSeen(place->first) ? places_.erase(place) : std::next(place);
  }
  pairs_.clear();
  findPlaces(heard, false);
  findPlaces(heard, true);
  takers_.clear();
  moved_.assign(moved_.size(), false);
  for (const auto& [known, place] : places_) {
    takers_.insert(place.taker);
    moved_[known] = true;
  }
  for (const auto& [known, last] : other_values_) {
    has_other_value_[known] =
        now_ - last <= model_->longestPause(known) && heard.lastSeen(known).value_or(last) <= last;
  }
}

bool Moved::any() const {
  return std::any_of(places_.begin(), places_.end(), [this](const auto& place) {
    return expected_[place.first] && !sent_.at(place.second.taker).accepted;
  });
}

std::vector<Suspect> Moved::suspects(bool all) const {
  struct Taker {
    EventId id = 0;
    std::int64_t first = 0;
    std::int64_t last = 0;
    std::set<std::string> topics;
    std::set<std::string> before;
  };
  std::map<std::string, Taker> takers;
  for (const auto& [known, place] : places_) {
    const EventId id = place.taker;
    if (sent_.at(id).accepted || !(all || expected_[known])) {
      continue;
    }
    const Sent& sent = sent_.at(id);
    Taker& taker =
        takers.try_emplace(typeOf(id).source, Taker{id, sent.first, 0, {}, {}}).first->second;
    taker.id = std::min(taker.id, id);
    taker.first = std::min(taker.first, sent.first);
    taker.last = std::max(taker.last, sent.last);
    taker.topics.insert(typeOf(id).scope);
    taker.before.insert(model_->vocabulary().at(known).source);
  }
  std::vector<Suspect> suspects;
  for (const auto& [source, taker] : takers) {
    Suspect suspect;
    suspect.id = taker.id;
    suspect.component = source;
    suspect.abnormal = true;
    suspect.onset = taker.first;
    suspect.reason =
        movedTo(source, of_source_.count(source) > 0, {taker.topics.begin(), taker.topics.end()},
                {taker.before.begin(), taker.before.end()}, toSeconds(now_ - taker.last));
    suspects.push_back(std::move(suspect));
  }
  return suspects;
}

}  // namespace self_awareness::core::evidence
