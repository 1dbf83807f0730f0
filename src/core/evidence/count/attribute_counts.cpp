#include "self_awareness/core/evidence/count/attribute_counts.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <tuple>

namespace self_awareness::core::evidence {
namespace {

using Step = Attributes::Step;

void add(const ClassCounts& counts, ClassCounts& sum) {
  for (const auto& [number, count] : counts) {
    sum[number] += count;
  }
}

}  // namespace

std::uint64_t total(const ClassCounts& counts) {
  std::uint64_t sum = 0;
  for (const auto& [number, count] : counts) {
    sum += count;
  }
  return sum;
}

std::uint8_t quantile(const ClassCounts& counts, double share) {
  const double wanted = share * static_cast<double>(total(counts));
  std::uint64_t sum = 0;
  for (const auto& [number, count] : counts) {
    sum += count;
    if (static_cast<double>(sum) >= wanted && sum > 0) {
      return number;
    }
  }
  return 0;
}

void AttributeCounts::merge(const AttributeCounts& other) {
  add(other.ages, ages);
  add(other.rises, rises);
  add(other.sizes, sizes);
  std::transform(steps.begin(), steps.end(), other.steps.begin(), steps.begin(), std::plus<>());
  repeats += other.repeats;
  longest_repeat = std::max(longest_repeat, other.longest_repeat);
}

std::uint64_t AttributeCounts::known() const {
  return std::accumulate(steps.begin(), steps.end(), std::uint64_t{0});
}

std::uint64_t AttributeCounts::numbered() const {
  return steps[static_cast<std::size_t>(Step::kNext)] +
         steps[static_cast<std::size_t>(Step::kSame)] + losses();
}

std::uint64_t AttributeCounts::losses() const {
  std::uint64_t sum = 0;
  for (auto step = static_cast<std::size_t>(Step::kLostOne);
       step <= static_cast<std::size_t>(Step::kLostMany); ++step) {
    sum += steps[step];
  }
  return sum;
}

double AttributeCounts::shareOfLosses() const {
  return numbered() > 0 ? static_cast<double>(losses()) / static_cast<double>(numbered()) : 0;
}

bool operator==(const AttributeCounts& a, const AttributeCounts& b) {
  return std::tie(a.ages, a.rises, a.sizes, a.steps, a.repeats, a.longest_repeat) ==
         std::tie(b.ages, b.rises, b.sizes, b.steps, b.repeats, b.longest_repeat);
}

}  // namespace self_awareness::core::evidence
