#include "core/evidence/channel/age.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/evidence/channel/messages.h"
#include "core/evidence/count/age_level.h"

namespace self_awareness::core::evidence {
namespace {

/// What tells an age from those two classes below [s].
double twoClasses(double age) {
  const double step = 1 + (age < 0 ? Attributes::kAheadStep : Attributes::kAgeStep);
  return (step * step - 1) * std::abs(age);
}

struct AgeOfMessages {
  struct Usual {
    double least_limit = 0;
    bool is_supported = true;
    double shortest = 0;  // [s]
    double middle = 0;
    double longest = 0;
  };

  void add(const Heard::Arrival& arrival, const Usual& usual, double most) {
    if (arrival.stalled) {
      return;  // it may have waited for that reason
    }
    before = last;
    if (arrival.attributes.hasAge()) {
      age = ageOf(arrival.attributes.age);
      last = level.add(arrival.stamp, age, {usual.shortest, usual.longest}, most);
    } else {
      age = Reason::kNone;
      last = toSeconds(AgeLevel::kSpan);  // a stamp that is missing is as bad
    }
  }
  double evidence() const { return std::min(last, before); }
  void explain(const Usual& usual, Reason& reason) const {
    reason.kind = Kind::kStale;
    reason.unit = unit::kSeconds;
    reason.value = age;
    reason.usual = usual.middle;
    reason.usual_shortest = usual.shortest;
    reason.usual_longest = usual.longest;
    char text[100];
    if (std::isnan(age)) {
      std::snprintf(text, sizeof text, "without a stamp, usually %.3f s old", usual.middle);
    } else if (age < 0) {
      std::snprintf(text, sizeof text, "stamps %.2f s in the future, usually %.3f s old", -age,
                    usual.middle);
    } else {
      std::snprintf(text, sizeof text, "stamps %.2f s old, usually %.3f s", age, usual.middle);
    }
    reason.words = text;
  }

  AgeLevel level;
  double age = 0;     // of the last message [s]
  double last = 0;    // by how much it is older than usual [s]
  double before = 0;  // the same of the message before
};

}  // namespace

std::vector<Track> Age::watch(const Choice& choice) const {
  return tracksOfMessages(*this, choice, [&](EventId id) {
    const AttributeCounts& counts = choice.both.type(id).attributes;
    const auto counted = static_cast<double>(counts.counted());
    const Tuning& tuning = choice.tuning;
    // Few may lack a stamp, and of the others, few may be older than they are by so much.
    const double usual = tuning.margin * tuning.least_lateness;
    const std::uint64_t large =
        total({counts.rises.upper_bound(ageClass(toNanoseconds(usual))), counts.rises.end()});
    const auto rises = static_cast<double>(total(counts.rises));
    return counted - rises <= tuning.rare * counted &&
           static_cast<double>(large) <= tuning.rare * rises;
  });
}

std::unique_ptr<const Expectation> Age::expect(const Model& model, const Halves& /*halves*/,
                                               std::vector<std::size_t> tracks) const {
  return std::make_unique<ExpectedMessages<AgeOfMessages>>(
      model, std::move(tracks), [&](EventId id) {
        ClassCounts ages = model.statistics().type(id).attributes.ages;
        ages.erase(Attributes::kZeroStamp);  // no age
        AgeOfMessages::Usual usual;
        usual.shortest = ageOf(quantile(ages, kUsualFrom));
        usual.middle = ageOf(quantile(ages, 0.5));
        usual.longest = ageOf(quantile(ages, kUsualTo));
        usual.least_limit = std::max(model.tuning().least_lateness, twoClasses(usual.middle));
        return usual;
      });
}

}  // namespace self_awareness::core::evidence
