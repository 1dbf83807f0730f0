#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>

#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/evidence/channel/watched.h"

namespace self_awareness::core::evidence {

/// Says which model judges a recording in the search for limits (docs/method.md, section 5.6). A
/// model finds the recordings that it learned from too normal. So a recording that was trained on
/// is judged by what the other half of the training says.
class CrossFit {
 public:
  /// @throw std::invalid_argument in the same cases as Model
  explicit CrossFit(const Watched& watched);

  /// Model of the whole training.
  const std::shared_ptr<const Model>& model() const { return model_; }
  /// Model that judges a recording; all models have the same tracks.
  /// @param half of the training that the recording belongs to, 0 or 1; none: it was not trained
  /// on
  /// @throw std::out_of_range if the half is another number
  const std::shared_ptr<const Model>& judging(std::optional<std::size_t> half) const;

 private:
  std::shared_ptr<const Model> model_;
  std::array<std::shared_ptr<const Model>, 2> others_;  // learned from the other half
};

}  // namespace self_awareness::core::evidence
