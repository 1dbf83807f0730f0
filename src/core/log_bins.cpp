#include "self_awareness/core/log_bins.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace self_awareness::core::log_bins {
namespace {

constexpr double kFirstEdge = 2.5e6;  // [ns]
constexpr double kBinsPerOctave = 4;

using Edges = std::array<std::int64_t, kBins - 1>;

Edges makeEdges() {
  Edges edges{};
  for (std::size_t k = 0; k < edges.size(); ++k) {
    edges[k] = std::llround(kFirstEdge * std::exp2(static_cast<double>(k) / kBinsPerOctave));
  }
  return edges;
}

// Whole nanoseconds: the same bin on every machine, however it rounds.
const Edges kEdges = makeEdges();

}  // namespace

std::size_t bin(std::int64_t delay) {
  return static_cast<std::size_t>(std::upper_bound(kEdges.begin(), kEdges.end(), delay) -
                                  kEdges.begin());
}

std::int64_t lowerEdge(std::size_t bin) {
  return bin == 0 ? 0 : kEdges.at(bin - 1);
}

double middle(std::size_t bin) {
  if (bin == 0) {
    return kFirstEdge / 2;
  }
  const auto lower = static_cast<double>(lowerEdge(bin));
  return bin + 1 == kBins ? lower : std::sqrt(lower * static_cast<double>(lowerEdge(bin + 1)));
}

}  // namespace self_awareness::core::log_bins
