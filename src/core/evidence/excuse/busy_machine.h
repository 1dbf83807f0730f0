#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "core/evidence/excuse/excuse.h"

namespace self_awareness::core::evidence {

/// The excuse that the machine has too much to do: it keeps processes waiting, or many components
/// that have nothing to do with each other are late at once (docs/method.md, section 6.1).
class BusyMachine : public Excuse {
 public:
  explicit BusyMachine(std::shared_ptr<const Model> model);

  Excused reason() const override { return Excused::kBusy; }
  std::optional<std::int64_t> closeWindow(const Unusual& window, Judgement& judgement) override;
  /// All but what messages hold; of who does not come, for as long as a busy machine may keep it.
  bool explains(const Excess& excess, const Unusual& window) const override;
  void restart() override;

 private:
  /// How late a component is.
  struct Lateness {
    std::int64_t since = kNever;  // [ns]
    std::int64_t last = kNever;   // end of the last window in which it was so [ns]
    std::set<std::size_t> after;  // components after which it was late, and itself
  };

  /// Who is late at once; none: too few to tell.
  std::optional<Busy> late(const Unusual& window);
  /// Takes note of who is late.
  void noteLate(const Unusual& window);
  /// Whether none of the late or silent ones explains most of those that are late.
  /// @param late components, in order
  bool areUnrelated(const std::vector<std::size_t>& late, const std::vector<bool>& silent,
                    const Causes& causes) const;
  static bool isRecent(std::int64_t stamp, std::int64_t now);
  /// Since when processes have been waiting, at the end of the window [ns]; none: they do not.
  std::optional<std::int64_t> starvedSince(const Heard& heard);
  /// Whether a busy machine may be why an event type has not come for so long.
  bool mayHold(EventId id, const Heard& heard) const {
    return heard.silence(id) <= model_->longestPause(id);
  }

  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();

  std::shared_ptr<const Model> model_;
  std::int64_t since_ = 0;                     // that it is busy, once it is [ns]
  std::optional<std::int64_t> busy_since_;     // many are late at once [ns]
  std::vector<Lateness> lateness_;             // by component
  std::optional<std::int64_t> starved_since_;  // [ns]
};

}  // namespace self_awareness::core::evidence
