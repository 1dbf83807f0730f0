#include "core/evidence/channel/silence.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <vector>

#include "self_awareness/core/evidence/channel/model.h"

namespace self_awareness::core::evidence {
namespace {

/// Whether it is a log line that warns, or tells of an error: that there is none is no fault.
bool isComplaint(const EventType& type) {
  const std::string level = valueOf(type);
  return type.scope == kLogTopic && !level.empty() && level != "level=1" && level != "level=2";
}

class SilenceState : public ChannelState {
 public:
  SilenceState(const Model& model, const std::vector<std::size_t>& tracks)
      : model_(model), tracks_(tracks), silences_(model.size()) {}

  void capAt(const std::vector<double>& limits) override {
    for (const std::size_t track : tracks_) {
      silences_[model_.tracks()[track].to].limit = limits[track];
    }
  }
  void restart() override {
    for (OfType& silence : silences_) {
      silence.age = 0;
      silence.more = 0;
    }
  }
  void closeWindow(const Heard& heard, std::vector<double>& evidence) override {
    for (const std::size_t track : tracks_) {
      const EventId id = model_.tracks()[track].to;
      OfType& silence = silences_[id];
      const EventId last = lastOf(id, heard);
      if (heard.silence(last) < silence.lasted) {
        learn(silence, id, toSeconds(heard.window()));
      }
      silence.lasted = heard.silence(last);
      silence.age = heard.hasSeen(id) ? toSeconds(heard.age(last)) : 0;
      evidence[track] = std::max(silence.age - silence.more, 0.0);
    }
  }
  double raisedBy(std::size_t track) const override {
    return silences_[model_.tracks()[track].to].more;
  }
  bool isCertain(std::size_t track, double limit, const Heard& heard) const override {
    return toSeconds(heard.age(lastOf(model_.tracks()[track].to, heard)) - heard.window()) >
           limit + raisedBy(track);
  }
  void explain(std::size_t /*track*/, const Heard& heard, const RecentEvents& /*events*/,
               Suspect& suspect) const override {
    const EventId id = suspect.id;
    Reason& reason = suspect.reason;
    reason.kind = Kind::kSilent;
    reason.unit = unit::kSeconds;
    const std::int64_t silence = heard.silence(lastOf(id, heard));
    reason.value = toSeconds(silence);
    reason.lasted = reason.value;
    reason.usual = model_.meanGap(id) * 1e-9;
    reason.usual_shortest = model_.usualDelay(id, id, kUsualFrom) * 1e-9;
    reason.usual_longest = model_.usualDelay(id, id, kUsualTo) * 1e-9;
    // One start may have shown more than all others agree on.
    const std::vector<std::int64_t>& gaps = model_.statistics().type(id).longest_gaps;
    const auto longer = std::partition_point(gaps.begin(), gaps.end(),
                                             [&](std::int64_t gap) { return gap > silence; }) -
                        gaps.begin();
    char text[120];
    std::snprintf(text, sizeof text, "silent for %.2f s, usually every %.3f s, %s %.3f s",
                  reason.value, reason.usual,
                  longer == 0   ? "at most"
                  : longer == 1 ? "longer once in training:"
                                : "longer now and then: up to",
                  toSeconds(model_.longestGap(id)));
    reason.words = text;
  }

 private:
  struct OfType {
    double limit = std::numeric_limits<double>::quiet_NaN();  // [s]; NaN: there is none
    double age = 0;                                           // at the end of the last window [s]
    double more = 0;          // that it has paused, beyond its limit [s]
    std::int64_t lasted = 0;  // age, stalls and all [ns]
  };

  /// What came last of an event type, and what was said in its place.
  EventId lastOf(EventId id, const Heard& heard) const {
    EventId last = id;
    for (const EventId other : model_.inPlaceOf(id)) {
      last = heard.lastSeen(other) > heard.lastSeen(last) ? other : last;
    }
    return last;
  }
  /// A silence is over. That one who pauses exceeds its limit is news once: it may pause for so
  /// long. A much longer silence is another thing.
  void learn(OfType& silence, EventId id, double window) const {
    const Tuning& tuning = model_.tuning();
    const double limit = silence.limit + silence.more;
    if (silence.age > limit && silence.age <= tuning.margin * limit && model_.pauses(id)) {
      silence.more = tuning.margin_of_silence * (silence.age + window) - window - silence.limit;
    }
  }

  const Model& model_;
  const std::vector<std::size_t>& tracks_;
  std::vector<OfType> silences_;  // by id
};

class ExpectedSilence : public Expectation {
 public:
  ExpectedSilence(const Model& model, std::vector<std::size_t> tracks)
      : Expectation(std::move(tracks)), model_(model) {}

  std::unique_ptr<ChannelState> start() const override {
    return std::make_unique<SilenceState>(model_, tracks());
  }
  double leastLimit(std::size_t /*track*/) const override { return 0; }
  double limit(std::size_t /*track*/, double /*largest*/, double most) const override {
    // Nothing is known of what came at one moment only.
    return most > 0 ? std::min(most, toSeconds(kLongestAge))
                    : std::numeric_limits<double>::quiet_NaN();
  }

 private:
  const Model& model_;
};

}  // namespace

std::vector<Track> Silence::watch(const Choice& choice) const {
  std::vector<Track> tracks;
  for (EventId id = 0; id < choice.both.size(); ++id) {
    if (choice.isJudged(id) && !isComplaint(choice.both.vocabulary().at(id))) {
      tracks.push_back({this, id, id});
    }
  }
  return tracks;
}

std::unique_ptr<const Expectation> Silence::expect(const Model& model, const Halves& /*halves*/,
                                                   std::vector<std::size_t> tracks) const {
  return std::make_unique<ExpectedSilence>(model, std::move(tracks));
}

}  // namespace self_awareness::core::evidence
