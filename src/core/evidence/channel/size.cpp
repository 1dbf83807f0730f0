#include "core/evidence/channel/size.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/evidence/channel/messages.h"

namespace self_awareness::core::evidence {
namespace {

constexpr double kClasses = 8;   // of an octave
constexpr double kUnused = 1e3;  // beyond all sizes [octaves]

struct Range {
  double smallest = 0;  // [octaves]
  double largest = 0;
};

Range rangeOf(const ClassCounts& sizes, double rare) {
  return {quantile(sizes, rare) / kClasses, quantile(sizes, 1 - rare) / kClasses};
}

struct SizeOfMessages {
  struct Usual {
    double least_limit = 0;
    bool is_supported = true;
    double smallest = 0;  // where smaller ones are unusual [octaves]
    double largest = 0;
    Range range;
  };

  void add(const Heard::Arrival& arrival, const Usual& usual, double /*most*/) {
    const double size = arrival.attributes.size / kClasses;
    last = arrival.attributes.size;
    std::rotate(beyond.begin(), beyond.begin() + 1, beyond.end());
    beyond.back() = size < usual.smallest  ? size - usual.smallest
                    : size > usual.largest ? size - usual.largest
                                           : 0;
  }
  double evidence() const {
    const auto [least, most] = std::minmax_element(beyond.begin(), beyond.end());
    return *least > 0 ? *least : *most < 0 ? -*most : 0;
  }
  void explain(const Usual& usual, Reason& reason) const {
    const auto bytes = [](double octaves) { return std::exp2(octaves - 1 / kClasses) - 1; };
    reason.kind = Kind::kOtherSize;
    reason.unit = "bytes";
    reason.value = sizeOf(last);
    reason.usual_shortest = bytes(usual.range.smallest);
    reason.usual_longest = bytes(usual.range.largest);
    reason.usual = (reason.usual_shortest + reason.usual_longest) / 2;
    char text[120];
    std::snprintf(text, sizeof text, "messages of about %.0f bytes, usually %.0f to %.0f",
                  reason.value, reason.usual_shortest, reason.usual_longest);
    reason.words = text;
  }

  std::uint8_t last = Attributes::kNoSize;
  std::array<double, 3> beyond{};  // of the last messages, the oldest first [octaves]
};

}  // namespace

std::vector<Track> Size::watch(const Choice& choice) const {
  return tracksOfMessages(*this, choice, [](EventId) { return true; });
}

std::unique_ptr<const Expectation> Size::expect(const Model& model, const Halves& halves,
                                                std::vector<std::size_t> tracks) const {
  return std::make_unique<ExpectedMessages<SizeOfMessages>>(
      model, std::move(tracks), [&](EventId id) {
        const Tuning& tuning = model.tuning();
        SizeOfMessages::Usual usual;
        usual.range = rangeOf(model.learned().type(id).attributes.sizes, tuning.rare);
        const ClassCounts& first = halves[0].type(id).attributes.sizes;
        const ClassCounts& second = halves[1].type(id).attributes.sizes;
        const Range one = rangeOf(first, tuning.rare);
        const Range other = rangeOf(second, tuning.rare);
        const bool both = !first.empty() && !second.empty();
        const bool small = both && std::abs(one.smallest - other.smallest) <= tuning.least_size;
        const bool large = both && std::abs(one.largest - other.largest) <= tuning.least_size;
        usual.is_supported = small || large;
        usual.smallest = small ? usual.range.smallest : -kUnused;
        usual.largest = large ? usual.range.largest : kUnused;
        usual.least_limit =
            std::max(tuning.least_size, usual.range.largest - usual.range.smallest);
        return usual;
      });
}

}  // namespace self_awareness::core::evidence
