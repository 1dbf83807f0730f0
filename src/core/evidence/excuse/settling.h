#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "core/evidence/channel/scorer.h"
#include "self_awareness/core/evidence/channel/model.h"

namespace self_awareness::core::evidence {

/// The excuse that something is new: an event type that has just begun, of which some was missed,
/// or that comes from two senders; or all, after this program stood still (docs/method.md, section
/// 4.4). What it covers is no evidence; who was silent before is silent still.
class Settling {
 public:
  explicit Settling(std::shared_ptr<const Model> model);

  /// Covers what an event type does up to a stamp [ns]; ignored if the model does not know it.
  void cover(EventId id, std::int64_t until);
  /// Covers what all do but their silence: who sends is heard again before it is unusual.
  void coverAll(std::int64_t until);
  /// Lets the scorer forget what its sums say of those that have settled since the window before.
  /// @param now start of the window [ns]
  void forgetStarts(std::int64_t now, Scorer& scorer);
  /// Takes back what tracks say of what it covers.
  /// @param now start of the window [ns]
  /// @param evidence by track
  void leaveOut(std::int64_t now, std::vector<double>& evidence) const;
  void restart();

 private:
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();

  std::shared_ptr<const Model> model_;
  std::vector<std::int64_t> until_;  // [ns], by id
  std::int64_t all_until_ = kNever;  // [ns]
  std::int64_t latest_ = kNever;     // of all of these [ns]
  bool any_ = false;                 // something did at the start of the last window
  std::int64_t last_window_ = 0;     // its start [ns]
};

}  // namespace self_awareness::core::evidence
