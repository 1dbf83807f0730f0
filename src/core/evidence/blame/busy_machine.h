#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "core/evidence/blame/followers.h"
#include "core/evidence/channel/scorer.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/verdict/busy.h"

namespace self_awareness::core::evidence {

/// Notices that the machine has too much to do: it keeps processes waiting, or many components
/// that have nothing to do with each other are late at once (docs/method.md, section 6).
class BusyMachine {
 public:
  explicit BusyMachine(std::shared_ptr<const Model> model);

  /// Takes in a window.
  /// @param shares of their limits that the tracks of the model have reached
  /// @param scorer that has closed the window
  /// @param events of the scorer's recording
  /// @param abnormal whether one of them is beyond its limit: else what was not busy is not
  /// @return none: the machine is not busy
  std::optional<Busy> closeWindow(const std::vector<double>& shares, const Scorer& scorer,
                                  const RecentEvents& events, bool abnormal);
  /// Forgets that it was busy.
  void restart();

 private:
  /// Who is late at once; none: too few to tell.
  std::optional<Busy> late(const std::vector<double>& shares, const Scorer& scorer,
                           const RecentEvents& events, bool abnormal);
  /// Since when processes have been waiting, at the end of the window [ns]; none: they do not.
  std::optional<std::int64_t> starvedSince(const Heard& heard);

  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

  std::shared_ptr<const Model> model_;
  Followers followers_;
  bool busy_ = false;                          // many were late at once
  std::int64_t since_ = 0;                     // then: since when [ns]
  std::vector<std::int64_t> late_since_;       // by component [ns]; kNever: it is not
  std::vector<std::int64_t> silent_at_;        // by component: at the last window so [ns]; 0: none
  std::optional<std::int64_t> starved_since_;  // [ns]
};

}  // namespace self_awareness::core::evidence
