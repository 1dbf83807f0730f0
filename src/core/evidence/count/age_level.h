#pragma once

#include <cstdint>
#include <limits>

namespace self_awareness::core::evidence {

/// Ages in training [s].
struct UsualAges {
  double youngest = 0;
  double oldest = 0;
};

/// By how much the messages of one event type are older than they have been of late
/// (docs/method.md, section 3.10). The clocks of two computers may differ, and drift apart: so
/// only what changes within a minute or two counts, and then for as long as it is so; and as ages
/// come in classes, no step to the next one.
class AgeLevel {
 public:
  /// What is remembered of ages: those of the last span, and of the one before [ns]; of old ages,
  /// longer spans.
  static constexpr std::int64_t kSpan = 60000000000;
  /// A stamp that is further ahead of the clock than before, by more than this [s], is wrong.
  static constexpr double kAhead = 0.5;

  static constexpr double kNone = std::numeric_limits<double>::infinity();

  /// Takes in a message.
  /// @param now when it came [ns]
  /// @param age since its stamp [s]; negative: it is of the future
  /// @param usual ages in training: who comes back to them is not ahead, nor too old for long
  /// @param most who is older by more [s], or ahead, says nothing of what is usual, however long
  /// that lasts; infinity: it is usual after a minute or two
  /// @return how much older it is than the class of the youngest of late, or how much further
  /// ahead [s]
  double add(std::int64_t now, double age, const UsualAges& usual = {}, double most = kNone);

 private:
  std::int64_t begin_ = 0;  // of the span [ns]
  bool begun_ = false;
  double youngest_ = kNone;  // age in the span [s]
  double before_ = kNone;    // the same of the span before
};

}  // namespace self_awareness::core::evidence
