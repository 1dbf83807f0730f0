#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/evidence/excuse/accepted.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::evidence {

/// Tells of players that play a recording on topics of this robot: they are none of its sources,
/// and the cause of what is unusual meanwhile (docs/method.md, section 6).
class Players {
 public:
  /// @param heard event types by id; may grow. None: nobody is named
  Players(const Model& model, std::shared_ptr<const Vocabulary> heard);

  /// Takes note of all that is played from now on.
  void set(const std::set<EventType>& played);
  /// Looks at who is accepted, at the end of a window.
  void closeWindow(Accepted& accepted);
  /// Whether somebody plays who is not accepted.
  bool any() const { return any_; }
  /// One for each player.
  const std::vector<Suspect>& suspects() const { return suspects_; }

 private:
  std::set<std::string> topics_;  // of the model
  std::shared_ptr<const Vocabulary> heard_;
  std::vector<Suspect> suspects_;
  bool any_ = false;
};

}  // namespace self_awareness::core::evidence
