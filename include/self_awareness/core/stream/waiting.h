#pragma once

#include <cstdint>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::core {

/// How long a machine kept its processes waiting, as a program on it has measured: in a stretch of
/// time, `waited` passed while at least one process was ready and had no processor. Nobody was
/// late by more for this reason (docs/method.md, section 3.7).
struct Waiting {
  std::int64_t from = 0;    ///< begin of the stretch [ns]
  std::int64_t to = 0;      ///< its end [ns]
  std::int64_t waited = 0;  ///< [ns], at most its length

  /// Whether the program that measured it stood still itself for as long as was waited, and says
  /// nothing of others. Who looks all the time has told a stretch long before so much of it was
  /// waited.
  bool stoodStill() const { return waited > kStoodStill; }
  static constexpr std::int64_t kStoodStill = kNanosecondsPerSecond / 2;  // [ns]
};

/// Tells a listener, by hear(), of the stretches of a recording that begin before a stamp [ns]:
/// live, one is measured before the windows are judged that end in it.
/// @return the first of those that are left
template <typename Iterator, typename Listener>
Iterator hearUntil(std::int64_t stamp, Iterator next, Iterator end, Listener& listener) {
  for (; next != end && next->from < stamp; ++next) {
    listener.hear(*next);
  }
  return next;
}

}  // namespace self_awareness::core
