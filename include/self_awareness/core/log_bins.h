#pragma once

#include <cstddef>
#include <cstdint>

namespace self_awareness::core {

/// How the evidence puts delays into bins (METHOD.md, section 3): four bins an octave from 2.5 ms
/// to 10.24 s, one for all below and one for all beyond. Relative precision is what delays of a
/// millisecond and of seconds have in common, and few bins are what counts of many pairs need.
namespace log_bins {

constexpr std::size_t kBins = 50;

/// Bin of a delay [ns]; a negative delay (a late stamp) counts as 0.
std::size_t bin(std::int64_t delay);
/// Smallest delay in a bin [ns]; 0 for the first one.
std::int64_t lowerEdge(std::size_t bin);
/// What stands for the delays in a bin [ns]: the geometric mean of its edges, for the first half
/// its upper edge, for the last its lower edge.
double middle(std::size_t bin);

}  // namespace log_bins
}  // namespace self_awareness::core
