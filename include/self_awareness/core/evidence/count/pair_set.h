#pragma once

#include <cstddef>
#include <vector>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::core::evidence {

/// Ordered pairs of event types; a million of them take as many bits.
class PairSet {
 public:
  void add(EventId to, EventId from) {
    if (rows_.size() <= to) {
      rows_.resize(to + 1);
    }
    if (rows_[to].size() <= from) {
      rows_[to].resize(from + 1);
    }
    rows_[to][from] = true;
  }
  bool contains(EventId to, EventId from) const {
    return to < rows_.size() && from < rows_[to].size() && rows_[to][from];
  }
  bool empty() const { return rows_.empty(); }
  /// Calls visit(to, from) for each, in order.
  template <typename Visit>
  void forEach(Visit visit) const {
    for (EventId to = 0; to < rows_.size(); ++to) {
      for (EventId from = 0; from < rows_[to].size(); ++from) {
        if (rows_[to][from]) {
          visit(to, from);
        }
      }
    }
  }

  friend bool operator==(const PairSet& a, const PairSet& b) { return a.rows_ == b.rows_; }

 private:
  std::vector<std::vector<bool>> rows_;  // by `to` and `from`; as long as needed
};

}  // namespace self_awareness::core::evidence
