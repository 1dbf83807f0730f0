#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace self_awareness::core::evidence {

/// Makes arithmetic possible on an array by bin. The array must outlive what is returned.
template <typename Value, std::size_t kSize>
Eigen::Map<Eigen::Array<Value, static_cast<int>(kSize), 1>> asArray(
    std::array<Value, kSize>& values) {
  return Eigen::Map<Eigen::Array<Value, static_cast<int>(kSize), 1>>(values.data());
}
template <typename Value, std::size_t kSize>
Eigen::Map<const Eigen::Array<Value, static_cast<int>(kSize), 1>> asArray(
    const std::array<Value, kSize>& values) {
  return Eigen::Map<const Eigen::Array<Value, static_cast<int>(kSize), 1>>(values.data());
}

}  // namespace self_awareness::core::evidence
