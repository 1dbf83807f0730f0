#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "self_awareness/core/evidence/count/trainer.h"
#include "self_awareness/core/evidence/tuning.h"

namespace self_awareness::core::evidence {

/// Finds the stalls of a recording of normal operation: times without any event that are seldom
/// (docs/method.md, section 3.7). What a recording shows of its robot's components is its time
/// without them.
class MachineStalls {
 public:
  explicit MachineStalls(const Tuning& tuning);
  /// @param stamp of the next event of the recording [ns]
  void add(std::int64_t stamp);
  /// The clock was set, which the stamps do not say by themselves (stream/clock_steps.h).
  void restart();
  /// The stalls so far, in their order.
  std::vector<MachineStall> find() const;

 private:
  /// A time without any event.
  struct Silence {
    MachineStall stall;
    std::size_t run = 0;  // between two steps of the clock
  };

  double margin_;
  std::int64_t shortest_;             // [ns]
  std::int64_t between_;              // [ns]
  std::optional<std::int64_t> last_;  // stamp of the event before [ns]; none: a run begins
  std::int64_t newest_ = 0;           // of the run [ns], once it had an event
  std::int64_t ran_ = 0;              // length of all runs [ns]
  std::size_t runs_ = 0;              // that have ended
  std::size_t events_ = 0;
  std::vector<Silence> silences_;  // that are long enough
};

}  // namespace self_awareness::core::evidence
