#pragma once

#include <cstdint>

namespace self_awareness::core {

/// How long a machine kept its processes waiting, as a program on it has measured: in a stretch of
/// time, `waited` passed while at least one process was ready and had no processor. Nobody was
/// late by more for this reason (docs/method.md, section 3.7).
struct Waiting {
  std::int64_t from = 0;    ///< begin of the stretch [ns]
  std::int64_t to = 0;      ///< its end [ns]
  std::int64_t waited = 0;  ///< [ns], at most its length
};

}  // namespace self_awareness::core
