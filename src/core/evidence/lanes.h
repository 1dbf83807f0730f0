#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/evidence/judge.h"

namespace self_awareness::core::evidence {

/// Keeps what the windows of a recording say of each component: the largest share of its limit in
/// each stretch of time. It is as large as what somebody draws of it, however long the recording.
class Lanes {
 public:
  /// A stretch of time.
  struct Column {
    std::vector<float> shares;         ///< the largest, by component
    float strongest_share = 0;         ///< the largest of all tracks
    std::optional<std::size_t> track;  ///< that has it; none: no track has any evidence
  };

  /// @param starts of the stretches [ns], in order: each ends where the next one begins, the last
  /// one with the recording
  /// @throw std::invalid_argument if they are not in order
  Lanes(std::shared_ptr<const Model> model, std::vector<std::int64_t> starts);

  /// Takes in what a window says. One that begins before all stretches is left out.
  void add(const Window& window, const Shares& shares);

  const std::vector<Column>& columns() const { return columns_; }

 private:
  std::shared_ptr<const Model> model_;
  std::vector<std::int64_t> starts_;
  std::vector<Column> columns_;
};

}  // namespace self_awareness::core::evidence
