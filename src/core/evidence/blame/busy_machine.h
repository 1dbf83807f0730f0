#pragma once

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
  /// @param abnormal whether one of them is beyond its limit: else what was not busy is not
  /// @return none: the machine is not busy
  std::optional<Busy> closeWindow(const std::vector<double>& shares, const Scorer& scorer,
                                  bool abnormal);
  /// Forgets that it was busy.
  void restart() {
    busy_ = false;
    starved_since_.reset();
  }

 private:
  /// Who is late at once; none: too few to tell.
  std::optional<Busy> late(const std::vector<double>& shares, const Scorer& scorer, bool abnormal);
  /// For how long processes have been waiting, at the end of the window [s]; 0: they do not.
  double starved(const Heard& heard);

  std::shared_ptr<const Model> model_;
  Followers followers_;
  bool busy_ = false;                          // many were late at once
  std::optional<std::int64_t> starved_since_;  // [ns]
};

}  // namespace self_awareness::core::evidence
