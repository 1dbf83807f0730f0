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
  /// The stalls so far, in their order.
  std::vector<MachineStall> find() const;

 private:
  double least_margin_;
  std::int64_t shortest_;              // [ns]
  std::int64_t between_;               // [ns]
  std::optional<std::int64_t> start_;  // stamp of the first event [ns]
  std::int64_t newest_ = 0;            // [ns], once there was an event
  std::size_t events_ = 0;
  std::vector<MachineStall> silences_;  // that are long enough
};

}  // namespace self_awareness::core::evidence
