#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "core/evidence/watch/heard.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/verdict/acceptance.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::evidence {

/// Knows what is no evidence: what somebody has accepted (docs/live.md).
class Accepted {
 public:
  /// @param heard event types by id, those of the model first; may grow. None: those that the
  /// model does not know are not known
  Accepted(std::shared_ptr<const Model> model, std::shared_ptr<const Vocabulary> heard);

  /// Takes what is accepted, in place of what was before.
  void accept(const Acceptances& accepted);
  /// Whether an event type of the model is one that may be absent, and was, for longer than rates
  /// count: a shorter gap is no absence.
  /// @param gap since its last event [ns]
  bool isBack(EventId id, std::int64_t gap) const {
    return is_optional_[id] && gap > model_->longestPause(id);
  }
  /// Whether an event type that the model does not know is accepted.
  bool isAcceptedStranger(EventId id);
  /// Whether something that an event type does is accepted, or it may be absent and is.
  bool isExcused(EventId id, Kind kind) const;
  /// Whether an event type of the model may be silent, by id.
  const std::vector<bool>& mayBeSilent() const { return may_be_silent_; }
  /// Takes back what tracks say of what is accepted, or of who is absent and may be.
  void leaveOut(const Heard& heard, std::vector<double>& evidence) const;
  /// Drops suspects that are so for what is accepted, or absent and may be.
  void leaveOut(std::vector<Suspect>& suspects) const;

 private:
  bool isAccepted(EventId id, Kind kind) const;
  /// Whether what a track says is accepted.
  bool covers(const Track& track) const;
  bool isAbsent(EventId id, const Heard& heard) const;

  std::shared_ptr<const Model> model_;
  std::shared_ptr<const Vocabulary> vocabulary_;  // of all that is heard
  Acceptances accepted_;
  std::vector<bool> is_optional_;        // by id of the model
  std::vector<std::size_t> optional_;    // tracks of them, whose evidence may be left out
  std::vector<std::size_t> tracks_;      // whose evidence is left out
  std::vector<bool> may_be_silent_;      // by id of the model
  std::map<EventId, bool> is_accepted_;  // event types that the model does not know, as looked at
};

}  // namespace self_awareness::core::evidence
