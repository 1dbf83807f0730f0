#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "self_awareness/core/stream/waiting.h"

namespace self_awareness {

/// Measures how long this machine keeps its processes waiting for a processor, by two signs: the
/// kernel's pressure (/proc/pressure/cpu, since Linux 4.20), which sees a machine with too much to
/// do, and how late the looks are, which sees one that itself gets no time, as in a virtual
/// machine. Where the kernel does not tell its pressure, there are the looks alone.
///
/// Belongs to one thread, which looks again and again.
class ProcessorWatch {
 public:
  ProcessorWatch();
  ~ProcessorWatch();
  ProcessorWatch(const ProcessorWatch&) = delete;
  ProcessorWatch& operator=(const ProcessorWatch&) = delete;

  /// A look at the machine.
  /// @param now ROS time [ns]
  /// @param steady_now steady time at the same moment [ns]
  /// @param pause that was meant to be between two looks [ns]
  /// @return what is known of the time since the last stretch: at the latest after a second, at
  /// once where processes wait; since the last look, if this program stood still. None: not yet
  std::optional<core::Waiting> look(std::int64_t now, std::int64_t steady_now, std::int64_t pause);
  /// Begins anew: ROS time was set.
  void restart() { stretch_.reset(); }

 private:
  struct Moment {
    std::int64_t steady = 0;  // [ns]
    std::int64_t pressure =
        0;                 // time for which processes have waited since the machine began [ns]
    std::int64_t own = 0;  // processor time of this thread [ns]
  };

  std::int64_t pressure() const;

  int file_;  // -1: the kernel does not tell
  Moment last_;
  std::optional<core::Waiting> stretch_;  // that is open; none: there was no look
};

/// The load of this machine during the last minute: "load 7.9 on 2 cores"; empty if the system
/// does not tell.
std::string loadInWords();

}  // namespace self_awareness
