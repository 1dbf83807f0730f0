#include "core/evidence/channel/silence.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <vector>

#include "self_awareness/core/evidence/channel/model.h"

namespace self_awareness::core::evidence {
namespace {

class SilenceState : public ChannelState {
 public:
  SilenceState(const Model& model, const std::vector<std::size_t>& tracks)
      : model_(model), tracks_(tracks) {}

  void closeWindow(const Heard& heard, std::vector<double>& evidence) override {
    for (const std::size_t track : tracks_) {
      const EventId id = model_.tracks()[track].to;
      evidence[track] = heard.hasSeen(id) ? toSeconds(heard.age(id)) : 0;
    }
  }
  bool isCertain(std::size_t track, double limit, const Heard& heard) const override {
    return toSeconds(heard.age(model_.tracks()[track].to) - heard.window()) > limit;
  }
  void explain(std::size_t /*track*/, const Heard& heard, const RecentEvents& /*events*/,
               Suspect& suspect) const override {
    const EventId id = suspect.id;
    Reason& reason = suspect.reason;
    reason.kind = Kind::kSilent;
    reason.unit = unit::kSeconds;
    reason.value = toSeconds(heard.silence(id));
    reason.lasted = reason.value;
    reason.usual = model_.meanGap(id) * 1e-9;
    reason.usual_shortest = model_.usualDelay(id, id, kUsualFrom) * 1e-9;
    reason.usual_longest = model_.usualDelay(id, id, kUsualTo) * 1e-9;
    // One start may have shown more than all others agree on.
    const std::vector<std::int64_t>& gaps = model_.statistics().type(id).longest_gaps;
    const auto longer =
        std::partition_point(gaps.begin(), gaps.end(),
                             [&](std::int64_t gap) { return gap > heard.silence(id); }) -
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
  const Model& model_;
  const std::vector<std::size_t>& tracks_;
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
    if (choice.isJudged(id)) {
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
