#include "core/evidence/channel/own_gaps.h"

#include <limits>

#include "core/evidence/channel/delays.h"
#include "self_awareness/core/evidence/channel/model.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

class ExpectedGaps : public ExpectedDelays {
 public:
  using ExpectedDelays::ExpectedDelays;
  std::unique_ptr<ChannelState> start() const override;
};

class OwnGapsState : public ChannelState {
 public:
  explicit OwnGapsState(const ExpectedGaps& expected);

  bool listens() const override { return !gaps_.empty(); }
  void add(const Heard::Arrival& arrival, const Heard& /*heard*/) override {
    const std::uint32_t number = number_of_[arrival.id];
    if (number == kNone || arrival.last == 0) {
      return;
    }
    OfType& own = gaps_[number];
    const std::int64_t gap = arrival.stamp - arrival.last_stamp;
    const double surprise =
        step(own.sum, own.catching_up, number, arrival.stamp, gap, arrival.stalled).surprise;
    if (own.arming.armed() || arrival.stalled) {
      return;
    }
    if (own.arming.failed()) {
      own.arming.add(surprise, arming_);
    } else {
      own.arming.arm();  // the history of one event type has no phase that could be another one
    }
  }
  void disarm(EventId id) override {
    const std::uint32_t number = number_of_[id];
    if (number != kNone) {
      gaps_[number].sum.clear();
      gaps_[number].arming.disarm();
    }
  }
  void forget(EventId id) override {
    if (number_of_[id] != kNone) {
      gaps_[number_of_[id]].sum.value = 0;
      gaps_[number_of_[id]].arming.forget();
    }
  }
  void restart() override;
  void capAt(const std::vector<double>& limits) override;
  void closeWindow(const Heard& heard, std::vector<double>& evidence) override;
  std::optional<std::int64_t> onset(std::size_t track) const override {
    return gaps_[expected_.numberOf(track)].sum.since;
  }
  void addDisarmed(std::vector<std::size_t>& tracks) const override {
    for (std::size_t number = 0; number < gaps_.size(); ++number) {
      if (gaps_[number].arming.failed() && !gaps_[number].arming.armed()) {
        tracks.push_back(expected_.tracks()[number]);
      }
    }
  }
  void explain(std::size_t track, const Heard& heard, const RecentEvents& events,
               Suspect& suspect) const override;

 private:
  struct OfType {
    DelaySum sum;
    CatchingUp catching_up;
    Arming arming;
  };
  struct Step {
    double surprise = 0;
    double added = 0;
  };

  Step step(DelaySum& sum, CatchingUp& catching_up, std::size_t number, std::int64_t stamp,
            std::int64_t gap, bool stalled) const {
    const double surprise = expected_.surprise(number)(gap);
    const bool makes_up = catching_up.add(static_cast<double>(gap), numbers_) && surprise > 0;
    return {surprise, sum.add(stamp, surprise, stalled ? 0.0 : 1.0, makes_up ? -1.0 : 1.0,
                              numbers_.shareOfRegime(gap), numbers_)};
  }

  const ExpectedGaps& expected_;
  DelayNumbers numbers_;
  Arming::Numbers arming_;
  bool has_limits_ = false;
  std::vector<std::uint32_t> number_of_;  // of the gaps of a type, by id
  std::vector<OfType> gaps_;              // by number of the track
};

std::unique_ptr<ChannelState> ExpectedGaps::start() const {
  return std::make_unique<OwnGapsState>(*this);
}

OwnGapsState::OwnGapsState(const ExpectedGaps& expected)
    : expected_(expected),
      numbers_(expected.model().tuning()),
      arming_(expected.model().tuning()),
      number_of_(expected.model().size(), kNone),
      gaps_(expected.tracks().size()) {
  for (std::uint32_t number = 0; number < gaps_.size(); ++number) {
    const EventId id = expected.track(number).to;
    number_of_[id] = number;
    gaps_[number].catching_up.mean_gap = expected.model().meanGap(id);
  }
}

void OwnGapsState::restart() {
  for (OfType& own : gaps_) {
    own.sum.clear();
    own.catching_up.behind = 0;
    own.arming = {};
  }
}

void OwnGapsState::capAt(const std::vector<double>& limits) {
  has_limits_ = true;
  for (std::size_t number = 0; number < gaps_.size(); ++number) {
    gaps_[number].sum.capAt(limits[expected_.tracks()[number]], numbers_);
  }
}

void OwnGapsState::closeWindow(const Heard& heard, std::vector<double>& evidence) {
  for (std::size_t number = 0; number < gaps_.size(); ++number) {
    OfType& own = gaps_[number];
    if (has_limits_ && own.arming.fails(own.sum.isAbnormal(numbers_), own.sum.value <= 0,
                                        heard.windowEnd(), arming_)) {
      own.sum.clear();
    }
    evidence[expected_.tracks()[number]] = own.arming.armed() ? own.sum.value : 0;
  }
}

void OwnGapsState::explain(std::size_t track, const Heard& heard, const RecentEvents& events,
                           Suspect& suspect) const {
  const std::size_t number = expected_.numberOf(track);
  const EventId id = suspect.id;
  const Model& model = expected_.model();
  DelaySum sum;
  sum.cap = gaps_[number].sum.cap;
  CatchingUp catching_up{gaps_[number].catching_up.mean_gap, 0};
  std::vector<SeenDelay> seen;
  std::optional<std::int64_t> last;
  for (const RecentEvents::Remembered& event : events.of(id, id)) {
    if (last) {
      const std::int64_t gap = event.stamp - *last;
      const Step added = step(sum, catching_up, number, event.stamp, gap, event.stalled);
      seen.push_back({event.stamp, static_cast<double>(gap), added.added});
    }
    last = event.stamp;
  }
  suspect.reason.usual_shortest = 1e-9 * model.usualDelay(id, id, 0.05);
  suspect.reason.usual_longest = 1e-9 * model.usualDelay(id, id, 0.95);
  describeDelays(seen, sum.cap, model.usualDelay(id, id, 0.5), heard.windowEnd(), suspect.reason);
}

}  // namespace

std::vector<Track> OwnGaps::watch(const Choice& choice) const {
  std::vector<Track> tracks;
  for (EventId id = 0; id < choice.both.size(); ++id) {
    if (choice.saysEnough(id, id)) {
      tracks.push_back({this, id, id});
    }
  }
  return tracks;
}

std::unique_ptr<const Expectation> OwnGaps::expect(const Model& model, const Halves& halves,
                                                   std::vector<std::size_t> tracks) const {
  return std::make_unique<ExpectedGaps>(model, halves, std::move(tracks));
}

}  // namespace self_awareness::core::evidence
