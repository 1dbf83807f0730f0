#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/evidence/channel/scorer.h"
#include "self_awareness/core/evidence/channel/model.h"

namespace self_awareness::core::evidence {

/// The excuse that something is new: an event type that has just begun, of which some was missed,
/// or that comes from two senders; or all, after this program stood still (docs/method.md, section
/// 4.4). What it covers is no evidence; who was silent before is silent still.
class Settling {
 public:
  explicit Settling(std::shared_ptr<const Model> model) : model_(std::move(model)) {}

  /// Covers what an event type does up to a stamp [ns]; ignored if the model does not know it.
  void cover(EventId id, std::int64_t until);
  /// Covers what all do but their silence: who sends is heard again before it is unusual.
  void coverAll(std::int64_t until);
  /// Ends what is over, and lets the scorer forget what its sums say of it.
  /// @param now start of the window [ns]
  void forgetStarts(std::int64_t now, Scorer& scorer);
  /// Takes back what tracks say of what it covers.
  /// @param evidence by track
  void leaveOut(std::vector<double>& evidence) const;
  void restart() {
    until_.clear();
    all_until_.reset();
  }

 private:
  std::shared_ptr<const Model> model_;
  std::map<EventId, std::int64_t> until_;  // of those that it covers [ns]
  std::optional<std::int64_t> all_until_;  // [ns]
};

}  // namespace self_awareness::core::evidence
