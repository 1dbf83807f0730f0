#include "core/evidence/channel/frozen.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/evidence/channel/messages.h"
#include "core/evidence/channel/sum.h"
#include "core/evidence/count/repeats.h"

namespace self_awareness::core::evidence {
namespace {

/// For how long the same content is more than chance [s], and more than a message sent twice.
double timeBeyondChance(const AttributeCounts& counts, double mean_gap, const Tuning& tuning) {
  const double repeats =
      (static_cast<double>(counts.repeats) + 1) / (static_cast<double>(counts.counted()) + 2);
  const double in_a_row =
      beyondChance(kNanosecondsPerHour / mean_gap, tuning) / -std::log(repeats);
  return std::max(tuning.most_mean_gaps, in_a_row) * mean_gap / kNanosecondsPerSecond;
}

/// For how long an event type was heard, and in how many starts.
struct HeardFor {
  HeardFor(const Statistics& counts, EventId id, const Tuning& tuning)
      : time(counts.type(id).gap_sum) {
    std::vector<Span> spans;
    for (const Statistics::Recording& recording : counts.recordings()) {
      if (id < recording.events.size() && recording.events[id] > 0) {
        spans.push_back({recording.start, recording.end, recording.robot_start, recording.robot});
      }
    }
    starts = numberOfStarts(spans, toNanoseconds(tuning.start_time));
  }

  std::int64_t time;  // [ns]
  std::size_t starts;
};

struct ContentOfMessages {
  struct Usual {
    double least_limit = 0;
    bool is_supported = true;
    double longest = 0;         // [s]
    std::int64_t mean_gap = 0;  // [ns]
  };

  void add(const Heard::Arrival& arrival, const Usual& usual, double /*most*/) {
    lasted = repeats.add(arrival.stamp, arrival.attributes, usual.mean_gap);
  }
  double evidence() const { return toSeconds(lasted); }
  void explain(const Usual& usual, Reason& reason) const {
    reason.kind = Kind::kStuck;
    reason.unit = unit::kSeconds;
    reason.value = toSeconds(lasted);
    reason.usual = usual.longest;
    reason.usual_shortest = 0;
    reason.usual_longest = usual.longest;
    reason.lasted = reason.value;
    char text[100];
    std::snprintf(text, sizeof text, "the same content for %.1f s, usually %.2f s at most",
                  reason.value, usual.longest);
    reason.words = text;
  }

  Repeats repeats;
  std::int64_t lasted = 0;  // the same content [ns]
};

}  // namespace

std::string Frozen::whyNot(const Statistics& counts, EventId id, const Tuning& tuning) const {
  const AttributeCounts& content = counts.type(id).attributes;
  const double longest = toSeconds(content.longest_repeat);
  const HeardFor heard(counts, id, tuning);
  char text[100] = "";
  if (counts.vocabulary().tellsMode(id) || content.counted() == 0) {
    return text;  // nothing of its messages is known
  }
  if (longest > timeBeyondChance(content, counts.type(id).meanGap(), tuning)) {
    std::snprintf(text, sizeof text, "it repeated for %.0f s in training", longest);
  } else if (static_cast<double>(content.repeats) >
             tuning.most_unusual * static_cast<double>(content.counted())) {
    return "it repeats itself";  // for as long as it likes
  } else if (toSeconds(heard.time) < tuning.changing_time ||
             static_cast<double>(heard.starts) < tuning.fewest_starts) {
    // A GPS without a fix, and a robot that stands, repeat themselves for as long as they like.
    // Fewer starts do not say that they never do.
    std::snprintf(text, sizeof text, "%.1f h in %zu start%s, %.0f h in %.0f are needed",
                  toSeconds(heard.time) / 3600, heard.starts, heard.starts == 1 ? "" : "s",
                  tuning.changing_time / 3600, tuning.fewest_starts);
  }
  return text;
}

std::vector<Track> Frozen::watch(const Choice& choice) const {
  return tracksOfMessages(
      *this, choice, [&](EventId id) { return whyNot(choice.both, id, choice.tuning).empty(); });
}

std::unique_ptr<const Expectation> Frozen::expect(const Model& model, const Halves& /*halves*/,
                                                  std::vector<std::size_t> tracks) const {
  return std::make_unique<ExpectedMessages<ContentOfMessages>>(
      model, std::move(tracks), [&](EventId id) {
        const Tuning& tuning = model.tuning();
        ContentOfMessages::Usual usual;
        const AttributeCounts& counts = model.statistics().type(id).attributes;
        usual.longest = toSeconds(counts.longest_repeat);
        usual.mean_gap = static_cast<std::int64_t>(model.meanGap(id));
        usual.least_limit =
            std::max({tuning.least_repeat, timeBeyondChance(counts, model.meanGap(id), tuning),
                      tuning.margin_of_silence * usual.longest});
        return usual;
      });
}

}  // namespace self_awareness::core::evidence
