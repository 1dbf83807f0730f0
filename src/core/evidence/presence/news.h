#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::evidence {

/// Knows what the senders of the training said: which values their type fields had, and what their
/// messages listed. Another list is news where each list of the sender came in two recordings of
/// the training: else it may have others still (Good, "The population frequencies of species and
/// the estimation of population parameters", 1953).
class News {
 public:
  /// @param heard event types by id, those of the model first; may grow. None: nothing is news
  News(const Model& model, std::shared_ptr<const Vocabulary> heard);

  /// Whether an event type that the model does not know tells a list that is news.
  bool isNewList(EventId id) const;
  /// Why an event type that the model does not know is news of a sender that it knows; none: it is
  /// not.
  std::optional<Reason> reasonOf(EventId id) const;

 private:
  /// A sender on a topic, with the type of its messages, without what that says besides.
  using Said = std::pair<EventType, std::string>;  // and the field; empty: of values

  /// What a sender listed.
  struct Lists {
    std::vector<std::set<std::string>> all;
    std::size_t fewest_recordings = 0;  // that one of them came in
  };

  std::shared_ptr<const Vocabulary> heard_;
  std::set<EventType> valued_;  // without their values
  std::map<Said, Lists> lists_;
};

}  // namespace self_awareness::core::evidence
