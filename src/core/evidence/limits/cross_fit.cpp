#include "self_awareness/core/evidence/limits/cross_fit.h"

namespace self_awareness::core::evidence {

CrossFit::CrossFit(const Watched& watched)
    : model_(std::make_shared<Model>(watched)),
      others_{std::make_shared<Model>(watched, Model::Learned::kSecond),
              std::make_shared<Model>(watched, Model::Learned::kFirst)} {}

const std::shared_ptr<const Model>& CrossFit::judging(std::optional<std::size_t> half) const {
  return half ? others_.at(*half) : model_;
}

}  // namespace self_awareness::core::evidence
