#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "self_awareness/core/evidence/count/statistics.h"

namespace self_awareness::core::evidence {

/// The counts of a training in two halves, with the same event types: what one says is tried on
/// the other (docs/method.md, section 3.1). They are those of the recordings of each half; if all
/// recordings belong to one half, those of the first and of the second part of each.
using Halves = std::array<Statistics, 2>;

/// The half that a recording belongs to, 0 or 1. It follows from the recording alone: not from the
/// order in which recordings come, nor from what else is trained on.
constexpr std::size_t halfOf(std::uint64_t fingerprint) {
  return fingerprint % 2;
}

/// Makes counts of the parts of recordings that all belong to one half counts by half.
/// @param half 0 or 1
void joinParts(Halves& counts, std::size_t half);

/// Adds the counts of other recordings; event types that are new here get the next ids.
/// @param only the half that all recordings of `counts` belong to; none: there are some of both
/// @param others_only the same, of `others`
void merge(Halves& counts, std::optional<std::size_t> only, const Halves& others,
           std::optional<std::size_t> others_only);

}  // namespace self_awareness::core::evidence
