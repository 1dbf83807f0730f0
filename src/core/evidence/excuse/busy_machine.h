#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "core/evidence/explain/excess.h"
#include "core/evidence/explain/explanation.h"
#include "self_awareness/core/verdict/busy.h"

namespace self_awareness::core::evidence {

/// The excuse that the machine has too much to do: it keeps processes waiting, or many components
/// that have nothing to do with each other are late at once (docs/method.md, section 6).
class BusyMachine {
 public:
  /// @param explanation says who follows whom
  BusyMachine(std::shared_ptr<const Model> model, const Explanation& explanation);

  /// Takes in a window, and excuses what began while the machine was busy; of who does not come,
  /// for as long as a busy machine may keep it.
  /// @param excesses all that is unusual
  /// @param scorer that has closed the window
  /// @param events of the scorer's recording
  /// @return none: the machine is not busy
  std::optional<Busy> excuse(std::vector<Excess>& excesses, const Scorer& scorer,
                             const RecentEvents& events);
  /// Forgets that it was busy.
  void restart();

 private:
  /// How late a component is.
  struct Lateness {
    std::int64_t since = kNever;  // [ns]
    std::int64_t last = kNever;   // end of the last window in which it was so [ns]
    std::set<std::size_t> after;  // components after which it was late, and itself
  };

  /// Who is late at once; none: too few to tell.
  std::optional<Busy> late(const std::vector<Excess>& excesses, const Scorer& scorer,
                           const RecentEvents& events);
  /// Takes note of who is late.
  void noteLate(const std::vector<Excess>& excesses, const Scorer& scorer,
                const RecentEvents& events);
  /// Whether none of the late or silent ones explains most of those that are late.
  /// @param late components, in order
  bool areUnrelated(const std::vector<std::size_t>& late, const std::vector<bool>& silent,
                    const std::vector<Excess>& excesses) const;
  static bool isRecent(std::int64_t stamp, std::int64_t now);
  /// Since when processes have been waiting, at the end of the window [ns]; none: they do not.
  std::optional<std::int64_t> starvedSince(const Heard& heard);
  /// Whether a busy machine may be why an event type has not come for so long.
  bool mayHold(EventId id, const Heard& heard) const;
  bool covers(const Excess& excess, const Busy& busy, const Heard& heard) const;

  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();

  std::shared_ptr<const Model> model_;
  const Explanation& explanation_;
  std::optional<std::int64_t> busy_since_;     // many are late at once [ns]
  std::vector<Lateness> lateness_;             // by component
  std::optional<std::int64_t> starved_since_;  // [ns]
};

}  // namespace self_awareness::core::evidence
