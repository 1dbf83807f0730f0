#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/evidence/excuse/accepted.h"
#include "core/evidence/watch/heard.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::evidence {

/// Notices what comes from another source than in training: the one that training knows was not
/// heard, and the other one sends the same on its topic, about as often (docs/method.md, section
/// 6). So it is after an update, or where a node has another name in every start. Also what comes
/// with another value than in training: who sends that on its topic is not silent there.
class Moved {
 public:
  /// @param heard event types by id, those of the model first; may grow. None: nobody is found
  /// @param expected event types of the model that come after every start, by id
  Moved(std::shared_ptr<const Model> model, std::shared_ptr<const Vocabulary> heard,
        std::vector<bool> expected);

  /// Takes in the next event, of any id.
  void add(const Event& event);
  /// Forgets who was heard.
  void restart();
  /// Looks at who has taken whose place, at the end of a window.
  void closeWindow(const Heard& heard, Accepted& accepted);
  /// Event types of the model that come from another source, by id: they need not come.
  const std::vector<bool>& moved() const { return moved_; }
  /// The same of those that come with another value: they are not silent.
  const std::vector<bool>& hasOtherValue() const { return has_other_value_; }
  /// Whether an event type that the model does not know has taken the place of another one.
  bool isPlaceOf(EventId unknown) const { return takers_.count(unknown) > 0; }
  /// Whether somebody has, who is not accepted, in place of one that is expected: nobody watches
  /// it.
  bool any() const;
  /// The sources that have taken the place of others and are not accepted, one suspect for each.
  /// @param all also in place of one that does not come after every start
  std::vector<Suspect> suspects(bool all) const;

 private:
  /// An event type that the model does not know.
  struct Sent {
    std::int64_t first = 0;  // stamps [ns]
    std::int64_t last = 0;
    std::uint64_t events = 0;
    bool accepted = false;
  };

  const EventType& typeOf(EventId id) const { return heard_->at(id); }
  /// Who has the place of an event type of the model.
  struct Place {
    EventId taker = 0;
    bool firm = false;  // it stays so until the other one is heard
  };

  /// Whether it comes about as often as another one did in training; none: it is too early to say.
  std::optional<bool> fits(const Sent& sent, EventId known) const;
  /// Whether a source stands for another one on a topic where everybody may send: it has taken its
  /// place on another one, or neither sends on any other.
  bool standsFor(const std::string& source, const std::string& known, const Heard& heard) const;
  void findPlaces(const Heard& heard, bool for_everybody);
  /// Notes that types with another value do not come where this one does.
  void addValue(const Event& event);

  std::shared_ptr<const Model> model_;
  std::shared_ptr<const Vocabulary> heard_;
  std::vector<bool> expected_;
  std::map<std::pair<std::string, std::string>, std::vector<EventId>> known_;  // by scope and type
  std::map<std::string, std::vector<EventId>> of_source_;  // event types of the model
  std::map<EventType, std::vector<EventId>> valued_;  // event types of the model, without a value
  std::map<EventId, std::int64_t> other_values_;      // when one came for one of the model [ns]
  std::map<EventId, Sent> sent_;                      // by unknown id
  std::map<EventId, Place> places_;                   // by id of the model
  std::set<std::pair<EventId, EventId>> others_;      // unknown id, known one: at another rate
  std::set<std::pair<std::string, std::string>> pairs_;  // of sources: who has whose place
  std::set<EventId> takers_;
  std::vector<bool> moved_;
  std::vector<bool> has_other_value_;
  std::int64_t now_ = 0;  // end of the last window [ns]
};

}  // namespace self_awareness::core::evidence
