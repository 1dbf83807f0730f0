#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include "self_awareness/core/evidence/tuning.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/verdict/persistence.h"

namespace self_awareness::core::evidence {

/// Whether what is watched counts (docs/method.md, section 3.7). Independent timers keep one phase
/// as long as they run, and have another one in every run: training may have met the same one by
/// chance every time. So a relation counts only after it has once been as in training. What was
/// abnormal, or is different for long, is news once, and then must be as in training again.
class Arming {
 public:
  /// So many failures double the events: a day of them at 1 Hz would not do.
  static constexpr std::uint32_t kMostDoublings = 10;

  /// The numbers that all have in common.
  struct Numbers {
    explicit Numbers(const Tuning& tuning)
        : events(static_cast<std::uint32_t>(tuning.arming_events)),
          news(static_cast<std::uint32_t>(Persistence::Parameters().alarm_windows)),
          accept_after(toNanoseconds(tuning.accept_after)) {}

    std::uint32_t events;
    std::uint32_t news;         // with fewer abnormal windows, it was none: they raise no alarm
    std::int64_t accept_after;  // [ns]
  };

  bool armed() const { return armed_; }
  /// Takes in one event of what is not armed. Every block of events that is not as in training
  /// doubles the next one.
  /// @param excess of what it adds to the sum of its track over what is as in training
  void add(double excess, const Numbers& numbers) {
    excess_ += excess;
    const std::uint64_t needed = std::uint64_t{numbers.events}
                                 << std::min(failures_, kMostDoublings);
    if (++events_ < needed) {
      return;
    }
    armed_ = excess_ <= 0;
    failures_ += armed_ ? 0 : 1;
    excess_ = 0;
    events_ = 0;
  }
  /// It must be as in training once more: one of its event types was gone, or the machine stood
  /// still.
  void disarm() { *this = after(failures_); }
  /// What was abnormal so far was a start, and is no failure.
  void forget() { abnormal_windows_ = 0; }
  /// Takes in a window.
  /// @param abnormal whether it is beyond its limit
  /// @param calm whether nothing unusual is left of it
  /// @param end of the window [ns]
  /// @return whether it has failed: what was news is over, or has lasted for so long that it has
  /// changed for good. Then it is disarmed.
  bool fails(bool abnormal, bool calm, std::int64_t end, const Numbers& numbers) {
    if (abnormal_windows_ == 0 && !(armed_ && abnormal)) {
      return false;
    }
    abnormal_since_ = abnormal_windows_ == 0 ? end : abnormal_since_;
    abnormal_windows_ += abnormal ? 1 : 0;
    if (calm && abnormal_windows_ < numbers.news) {
      forget();
      return false;
    }
    if (!calm && end - abnormal_since_ < numbers.accept_after) {
      return false;
    }
    *this = after(failures_ + 1);
    return true;
  }

  Arming() = default;
  /// @param armed whether it counts from the start on
  explicit Arming(bool armed) : armed_(armed) {}

 private:
  static Arming after(std::uint32_t failures) {
    Arming anew;
    anew.failures_ = failures;
    return anew;
  }

  double excess_ = 0;  // of the events of the block
  std::uint32_t events_ = 0;
  std::uint32_t failures_ = 0;
  bool armed_ = false;
  std::uint32_t abnormal_windows_ = 0;  // since it was calm; 0: it is normal
  std::int64_t abnormal_since_ = 0;     // the first of them [ns]
};

/// The same of who waits: it counts from the start on. That what was missing came after all is
/// news once; what does not come is missing for as long as it does not.
class WaitArming {
 public:
  bool armed() const { return arming_.armed(); }
  /// Takes in a wait that is over, with as much evidence as there was then.
  void add(double evidence, const Arming::Numbers& numbers) {
    if (!armed()) {
      arming_.add(evidence > limit_ ? 1 : 0, numbers);
    }
  }
  /// What was missing has come. Its evidence alone does not say so: stalls take from it, too.
  void come() { came_ = true; }
  /// Takes in a window. @return the evidence that counts
  double counted(double evidence, const Arming::Numbers& numbers) {
    if (std::exchange(came_, false)) {
      arming_.fails(false, true, 0, numbers);
    }
    arming_.fails(evidence > limit_, false, 0, numbers);
    return armed() ? evidence : 0;
  }
  /// It did not come late, but its component was gone.
  void forget() { arming_.forget(); }
  /// @param limit of the evidence; NaN: it has none
  void limitTo(double limit) { limit_ = limit; }
  void restart() { arming_ = Arming(true); }

 private:
  Arming arming_{true};
  bool came_ = false;  // since the last window
  double limit_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace self_awareness::core::evidence
