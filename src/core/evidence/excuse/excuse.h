#pragma once

#include <cstdint>
#include <optional>

#include "core/evidence/explain/unusual.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/verdict/acceptance.h"
#include "self_awareness/core/verdict/judge.h"

namespace self_awareness::core::evidence {

/// Whether something unusual began since a time [ns]. What does not come, or too seldom, may have
/// been so for its longest usual gap before anybody could see it.
bool beganSince(std::int64_t since, const Excess& excess, const Model& model);

/// Why what is unusual is nobody's fault (docs/method.md, section 6.1). An excuse sees all that is
/// unusual, whatever others excuse of it: their order does not matter, but that what is accepted
/// is known first. It covers what began since it holds, at most: Excuses has that rule.
class Excuse {
 public:
  virtual ~Excuse() = default;

  /// What it is, in the last window that it held in.
  virtual Excused reason() const = 0;
  /// Takes in a window.
  /// @param judgement gets what it found, with suspects that are told though not to blame
  /// @return since when it holds [ns]; none: it does not
  virtual std::optional<std::int64_t> closeWindow(const Unusual& window, Judgement& judgement) = 0;
  /// Whether it may be why something is unusual, if that began since it holds.
  virtual bool explains(const Excess& excess, const Unusual& window) const = 0;
  /// Takes what is accepted, in place of that of before.
  virtual void accept(const Acceptances& /*accepted*/) {}
  /// Forgets that it held.
  virtual void restart() = 0;
};

}  // namespace self_awareness::core::evidence
