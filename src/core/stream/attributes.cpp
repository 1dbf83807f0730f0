#include "self_awareness/core/stream/attributes.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace self_awareness::core {
namespace {

constexpr double kShortest = 1e6;  // [ns]
constexpr double kOctaves = 8;     // classes of one, of ages and of sizes
constexpr double kOctavesAhead = 4;
constexpr int kPast = 168;  // classes
constexpr int kAhead = 84;  // classes
constexpr int kNow = Attributes::kYoungest + kAhead;
static_assert(kNow + kPast == 254, "a class has one byte");

/// Number of the class of a time of kShortest or more.
int classOf(double time, double octaves, int classes) {
  return std::min(static_cast<int>(octaves * std::log2(time / kShortest)), classes - 1);
}

double middleOf(int number, double octaves) {
  return kShortest * 1e-9 * std::exp2((number + 0.5) / octaves);
}

}  // namespace

std::uint8_t ageClass(std::int64_t age) {
  const auto time = static_cast<double>(age);
  int number = kNow;
  if (time >= kShortest) {
    number += 1 + classOf(time, kOctaves, kPast);
  } else if (time <= -kShortest) {
    number -= 1 + classOf(-time, kOctavesAhead, kAhead);
  }
  return static_cast<std::uint8_t>(number);
}

double ageOf(std::uint8_t age_class) {
  const int number = age_class - kNow;
  return number == 0  ? 0
         : number > 0 ? middleOf(number - 1, kOctaves)
                      : -middleOf(-number - 1, kOctavesAhead);
}

std::uint8_t sizeClass(std::uint64_t bytes) {
  const double number = std::round(kOctaves * std::log2(1 + static_cast<double>(bytes)));
  return static_cast<std::uint8_t>(1 + std::min(number, Attributes::kLargestSize - 1.0));
}

double sizeOf(std::uint8_t size_class) {
  return std::exp2((size_class - 1) / kOctaves) - 1;
}

Attributes::Step stepOf(std::uint32_t before, std::uint32_t number) {
  using Step = Attributes::Step;
  const std::uint32_t step = number - before;
  if (step == 0) {
    return Step::kSame;
  }
  const std::uint32_t lost = step - 1;
  return lost == 0                       ? Step::kNext
         : lost == 1                     ? Step::kLostOne
         : lost <= 3                     ? Step::kLostFew
         : lost <= 15                    ? Step::kLostSome
         : lost <= Attributes::kMostLost ? Step::kLostMany
                                         : Step::kRestart;
}

std::uint32_t packed(const Attributes& attributes) {
  return attributes.age | static_cast<std::uint32_t>(attributes.size) << 8U |
         static_cast<std::uint32_t>(attributes.step) << 16U | (attributes.same ? 1U << 24U : 0U);
}

Attributes unpackedAttributes(std::uint32_t number) {
  const std::uint32_t step = number >> 16U & 0xffU;
  if (step >= Attributes::kSteps || number >> 25U != 0) {
    throw std::invalid_argument("no attributes of a message: " + std::to_string(number));
  }
  return {static_cast<std::uint8_t>(number & 0xffU),
          static_cast<std::uint8_t>(number >> 8U & 0xffU), static_cast<Attributes::Step>(step),
          (number >> 24U & 1U) != 0};
}

}  // namespace self_awareness::core
