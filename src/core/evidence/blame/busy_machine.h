#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/evidence/blame/followers.h"
#include "core/evidence/channel/scorer.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/verdict/busy.h"

namespace self_awareness::core::evidence {

/// Notices that many components that have nothing to do with each other are late at once: the
/// machine that they run on has too much to do (docs/method.md, section 6).
class BusyMachine {
 public:
  explicit BusyMachine(std::shared_ptr<const Model> model);

  /// Takes in a window, of which something is abnormal or was just before.
  /// @param shares of their limits that the tracks of the model have reached
  /// @param scorer that has closed the window
  /// @param abnormal whether one of them is beyond its limit: else what was not busy is not
  /// @return none: the machine is not busy
  std::optional<Busy> closeWindow(const std::vector<double>& shares, const Scorer& scorer,
                                  bool abnormal);
  /// Forgets that it was busy.
  void restart() { busy_ = false; }

 private:
  std::shared_ptr<const Model> model_;
  Followers followers_;
  bool busy_ = false;
};

}  // namespace self_awareness::core::evidence
