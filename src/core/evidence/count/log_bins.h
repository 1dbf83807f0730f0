#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "self_awareness/core/evidence/count/statistics.h"

namespace self_awareness::core::evidence {

/// The bins of delays in the evidence detector (docs/method.md, section 3.1): four an octave from
/// 2.5 ms to 10.24 s, one for all shorter and one for all longer delays. Relative precision suits
/// delays of milliseconds and of seconds, and few bins keep the counts of many pairs small.
namespace log_bins {

constexpr std::size_t kBins = kDelayBins;
/// The edges in an octave, as ratios to the first one.
inline constexpr std::array<double, 4> kInOctave{1, 1.189207115002721, 1.4142135623730951,
                                                 1.681792830507429};

namespace detail {

constexpr std::int64_t kFirstEdge = 2500000;  // [ns]

/// Lower edges of all bins but the first [ns]. They are whole nanoseconds, so a delay falls into
/// the same bin on every machine, however it rounds.
constexpr std::array<std::int64_t, kBins - 1> makeEdges() {
  std::array<std::int64_t, kBins - 1> edges{};
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const auto octave = static_cast<double>(kFirstEdge << (k / kInOctave.size()));
    // std::llround is not constexpr. NOLINTNEXTLINE(bugprone-incorrect-roundings)
    edges[k] = static_cast<std::int64_t>(octave * kInOctave[k % kInOctave.size()] + 0.5);
  }
  return edges;
}

inline constexpr std::array<std::int64_t, kBins - 1> kEdges = makeEdges();

/// An eighth of the range between two powers of two: at most one edge lies in it.
struct Eighth {
  std::int64_t edge = 0;  // [ns]
  std::size_t below = 0;  // bin of delays shorter than the edge
};

constexpr std::size_t kFirstExponent = 21;  // 2^21 ns < kFirstEdge
constexpr std::size_t kExponents = 13;      // to beyond the last edge

constexpr std::array<Eighth, 8 * kExponents> makeEighths() {
  std::array<Eighth, 8 * kExponents> eighths{};
  for (std::size_t k = 0; k < eighths.size(); ++k) {
    const std::uint64_t start = ((std::uint64_t{8} + k % 8) << (kFirstExponent + k / 8)) / 8;
    std::size_t bin = 0;
    while (bin < kEdges.size() && kEdges[bin] <= static_cast<std::int64_t>(start)) {
      ++bin;
    }
    eighths[k].below = bin;
    eighths[k].edge = bin < kEdges.size() ? kEdges[bin] : INT64_MAX;
  }
  return eighths;
}

inline constexpr std::array<Eighth, 8 * kExponents> kEighths = makeEighths();

}  // namespace detail

/// Bin of a delay [ns]; a negative delay (a late stamp) counts as 0.
inline std::size_t bin(std::int64_t delay) {
  // The exponent of a double and the first three bits after its point replace a search.
  const auto within =
      static_cast<double>(std::clamp(delay, detail::kFirstEdge - 1, detail::kEdges.back()));
  static_assert(sizeof within == sizeof(std::uint64_t), "a double has 64 bits");
  std::uint64_t bits = 0;
  std::memcpy(&bits, &within, sizeof bits);
  constexpr std::uint64_t kBias = 1023;
  const detail::Eighth& eighth =
      detail::kEighths[(bits >> 49U) - ((kBias + detail::kFirstExponent) << 3U)];
  return eighth.below + (delay >= eighth.edge ? 1 : 0);
}

/// Smallest delay in a bin [ns]; 0 for the first one.
std::int64_t lowerEdge(std::size_t bin);
/// Delay that stands for all delays in a bin [ns]: the geometric mean of its edges; for the first
/// bin half its upper edge, for the last its lower edge.
double middle(std::size_t bin);

}  // namespace log_bins
}  // namespace self_awareness::core::evidence
