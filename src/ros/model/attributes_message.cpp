#include "attributes_message.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "check.h"

namespace self_awareness::ros1 {
namespace {

namespace evidence = core::evidence;

// Of one class: what all classes of both halves say is added up.
constexpr std::uint64_t kLargestCount = std::uint64_t{1} << 53U;

void setCounts(const evidence::ClassCounts& counts, std::vector<std::uint8_t>& classes,
               std::vector<std::uint64_t>& numbers) {
  for (const auto& [number, count] : counts) {
    classes.push_back(number);
    numbers.push_back(count);
  }
}

evidence::ClassCounts countsOf(const std::vector<std::uint8_t>& classes,
                               const std::vector<std::uint64_t>& numbers) {
  check(classes.size() == numbers.size(), "its attributes do not fit their classes");
  evidence::ClassCounts counts;
  for (std::size_t k = 0; k < classes.size(); ++k) {
    check(numbers[k] < kLargestCount, "its attributes have counts that cannot be");
    check(counts.emplace(classes[k], numbers[k]).second, "its attributes have a class twice");
  }
  return counts;
}

}  // namespace

self_awareness::AttributeCounts toMessage(const evidence::AttributeCounts& counts) {
  self_awareness::AttributeCounts message;
  setCounts(counts.ages, message.age_classes, message.age_counts);
  setCounts(counts.rises, message.rise_classes, message.rise_counts);
  setCounts(counts.sizes, message.size_classes, message.size_counts);
  message.steps.assign(counts.steps.begin(), counts.steps.end());
  message.repeats = counts.repeats;
  message.longest_repeat = counts.longest_repeat;
  return message;
}

evidence::AttributeCounts fromMessage(const self_awareness::AttributeCounts& message) {
  evidence::AttributeCounts counts;
  counts.ages = countsOf(message.age_classes, message.age_counts);
  counts.rises = countsOf(message.rise_classes, message.rise_counts);
  counts.sizes = countsOf(message.size_classes, message.size_counts);
  check(message.steps.size() == counts.steps.size(), "its attributes do not fit their classes");
  std::copy(message.steps.begin(), message.steps.end(), counts.steps.begin());
  counts.repeats = message.repeats;
  counts.longest_repeat = message.longest_repeat;
  for (const std::uint64_t step : counts.steps) {
    check(step < kLargestCount, "its attributes have counts that cannot be");
  }
  check(counts.counted() <= counts.known() &&
            std::max({evidence::total(counts.ages), evidence::total(counts.rises),
                      counts.repeats}) <= counts.counted(),
        "its attributes are of more messages than there are");
  check(areTimes({counts.longest_repeat}, 0), "its attributes have a time that cannot be");
  return counts;
}

}  // namespace self_awareness::ros1
