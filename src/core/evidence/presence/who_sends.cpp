#include "core/evidence/presence/who_sends.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kSinceEver = std::numeric_limits<std::int64_t>::min();

void append(const std::vector<Suspect>& suspects, std::vector<Suspect>& all) {
  all.insert(all.end(), suspects.begin(), suspects.end());
}

}  // namespace

WhoSends::WhoSends(const std::shared_ptr<const Model>& model,
                   const std::shared_ptr<const Vocabulary>& heard,
                   std::shared_ptr<const SourceGraph> graph, std::vector<bool> expected)
    : strangers_(*model, heard, std::move(graph)),
      moved_(model, heard, std::move(expected)),
      two_senders_(model),
      players_(*model, heard) {}

bool WhoSends::add(const Event& event, Accepted& accepted) {
  moved_.add(event);
  return strangers_.add(event, accepted);
}

void WhoSends::set(const Senders& senders) {
  two_senders_.set(senders.doubled);
  players_.set(senders.played);
}

void WhoSends::restart() {
  strangers_.restart();
  moved_.restart();
  two_senders_.restart();
}

void WhoSends::closeWindow(const Heard& heard, Accepted& accepted) {
  moved_.closeWindow(heard, accepted);
  players_.closeWindow(accepted);
  two_senders_.closeWindow(heard);
  is_new_list_ = strangers_.anyList(heard.windowEnd());
}

std::vector<bool> WhoSends::needNotCome(std::vector<bool> may_be_silent) const {
  std::transform(may_be_silent.begin(), may_be_silent.end(), moved_.moved().begin(),
                 may_be_silent.begin(), std::logical_or<>());
  return may_be_silent;
}

std::vector<EventId> WhoSends::doubled() const {
  return two_senders_.any() ? two_senders_.types() : std::vector<EventId>();
}

std::set<std::string> WhoSends::evidence() const {
  std::set<std::string> evidence;
  if (two_senders_.any()) {
    evidence.insert("two senders");
  }
  if (moved_.any()) {
    evidence.insert("other sender");
  }
  if (players_.any()) {
    evidence.insert("player");
  }
  if (is_new_list_) {
    evidence.insert("lists");
  }
  return evidence;
}

std::vector<Suspect> WhoSends::causes(const Window& window, const Scorer& scorer,
                                      std::int64_t since, const Suspect& unusual) const {
  std::vector<Suspect> causes = two_senders_.suspects(scorer.heard());
  append(players_.suspects(), causes);
  const std::vector<Suspect> explain =
      strangers_.suspects(window, scorer, moved_, since, &unusual);
  if (!explain.empty()) {
    causes.push_back(explain.front());
  }
  return causes;
}

void WhoSends::dropMovers(std::vector<Suspect>& suspects) const {
  suspects.erase(std::remove_if(suspects.begin(), suspects.end(),
                                [this](const Suspect& suspect) {
                                  return moved_.isPlaceOf(suspect.id) &&
                                         suspect.reason.topics.empty();
                                }),
                 suspects.end());
}

std::vector<Suspect> WhoSends::alone(const Window& window, const Scorer& scorer, bool all) const {
  std::vector<Suspect> named = two_senders_.suspects(scorer.heard());
  append(players_.suspects(), named);
  append(moved_.suspects(all), named);
  append(strangers(window, scorer, kSinceEver), named);
  if (all) {
    strangers_.addUnknown(window, kSinceEver, named);
    dropMovers(named);
  }
  return named;
}

}  // namespace self_awareness::core::evidence
