#include "core/evidence/channel/owed.h"

#include <algorithm>
#include <cstdio>
#include <limits>

#include "self_awareness/core/evidence/channel/model.h"

namespace self_awareness::core::evidence {
namespace {

// All but as many answers as this leaves out on both sides take no longer than usual.
constexpr double kUsualAnswers = 0.9;

class ExpectedAnswers : public Expectation {
 public:
  ExpectedAnswers(const Model& model, std::vector<std::size_t> tracks)
      : Expectation(std::move(tracks)), model_(model) {
    double missing = 0.5;  // as in missRate()
    double asked = 1;
    for (const std::size_t track : this->tracks()) {
      if (!areSeries(track)) {
        const Track& owed = model_.tracks()[track];
        const auto requests = static_cast<double>(model_.statistics().type(owed.from).gaps);
        const auto answers = static_cast<double>(model_.statistics().answers(owed.from, owed.to));
        missing += std::max(requests * (1 - tooSoon(owed)) - answers, 0.0);
        asked += requests;
      }
    }
    fail_ = missing / asked > model_.tuning().rare_misses;
  }

  std::unique_ptr<ChannelState> start() const override;
  double leastLimit(std::size_t track) const override {
    const Tuning& tuning = model_.tuning();
    // What usual answers take is normal, also where no request before them counts.
    return countsRequests(track) ? tuning.least_requests
                                 : std::max(tuning.least_lateness,
                                            tuning.margin_of_waiting * 1e-9 * usualAnswer(track));
  }
  /// A usual answer takes no longer [ns].
  double usualAnswer(std::size_t track) const {
    const Track& owed = model_.tracks()[track];
    return model_.usualDelay(owed.from, owed.to, (1 + kUsualAnswers) / 2);
  }
  double timeUntil(std::size_t track, double evidence) const override {
    return evidence * (countsRequests(track) ? model_.meanGap(model_.tracks()[track].from) : 1e9);
  }
  double limit(std::size_t track, double largest, double most) const override {
    const EventId to = model_.tracks()[track].to;
    return timeUntil(track, largest) <
                   model_.tuning().owed_of_silence * static_cast<double>(model_.longestSilence(to))
               ? most
               : std::numeric_limits<double>::quiet_NaN();
  }
  /// Whether requests come in series, or stay without an answer now and then, and are counted.
  bool countsRequests(std::size_t track) const {
    const Track& owed = model_.tracks()[track];
    const Statistics& counts = model_.statistics();
    return fail_ || areSeries(track) ||
           missRate(counts.type(owed.from).gaps, counts.answers(owed.from, owed.to)) >
               tooSoon(owed) + model_.tuning().rare_misses;
  }
  const Model& model() const { return model_; }

 private:
  bool areSeries(std::size_t track) const {
    return model_.meanGap(model_.tracks()[track].from) < static_cast<double>(kRateSpan);
  }
  /// Share of the requests that the next one follows before an answer may be expected.
  double tooSoon(const Track& owed) const {
    const DelayHistogram& gaps = model_.statistics().delays(owed.from, owed.from);
    const std::size_t latest =
        model_.statistics().delays(owed.from, owed.to).middle(kUsualAnswers).last;
    double shorter = 0;
    for (std::size_t bin = 0; bin <= latest; ++bin) {
      shorter += gaps[bin];
    }
    return shorter / static_cast<double>(std::max<std::uint64_t>(gaps.total(), 1));
  }

  const Model& model_;
  bool fail_ = false;  // those of this robot that are not asked for in series, now and then
};

class OwedState : public ChannelState {
 public:
  explicit OwedState(const ExpectedAnswers& expected);

  bool listens() const override { return !owed_.empty(); }
  void add(const Heard::Arrival& arrival, const Heard& heard) override {
    for (const std::uint32_t number : asks_[arrival.id].answered) {
      owed_[number].requests = 0;
    }
    if (arrival.stalled) {
      return;  // what waited comes all at once, before any answer to it
    }
    for (const std::uint32_t number : asks_[arrival.id].asked) {
      Answer& answer = owed_[number];
      // Two that answer to the same come in any order: what it asks for may have come before it.
      const std::optional<std::int64_t> answered = heard.lastSeen(answer.to);
      if (answered && arrival.stamp - *answered < answer.usual) {
        continue;
      }
      answer.since = answer.requests > 0 ? answer.since : arrival.stamp;
      ++answer.requests;
    }
  }
  void restart() override {
    for (Answer& answer : owed_) {
      answer.requests = 0;
    }
  }
  void closeWindow(const Heard& heard, std::vector<double>& evidence) override;
  std::optional<std::int64_t> onset(std::size_t track) const override {
    return answerOf(track).since;
  }
  void explain(std::size_t track, const Heard& heard, const RecentEvents& events,
               Suspect& suspect) const override;

 private:
  struct Answer {
    std::size_t track = 0;
    EventId to = 0;
    bool in_requests = false;    // else in seconds
    std::int64_t usual = 0;      // a usual answer takes no longer [ns]; 0: in requests
    std::uint32_t requests = 0;  // without an answer
    std::int64_t since = 0;      // stamp of the first of them [ns], if there is one
  };
  /// Numbers of answers: that an event type asks for, and that it is.
  struct OfType {
    std::vector<std::uint32_t> asked;
    std::vector<std::uint32_t> answered;
  };

  const Answer& answerOf(std::size_t track) const {
    return *std::find_if(owed_.begin(), owed_.end(),
                         [track](const Answer& each) { return each.track == track; });
  }
  static double waiting(const Answer& answer, const Heard& heard) {
    return answer.in_requests ? answer.requests : toSeconds(heard.windowEnd() - answer.since);
  }

  const Model& model_;
  std::vector<Answer> owed_;
  std::vector<OfType> asks_;  // by id
};

std::unique_ptr<ChannelState> ExpectedAnswers::start() const {
  return std::make_unique<OwedState>(*this);
}

OwedState::OwedState(const ExpectedAnswers& expected)
    : model_(expected.model()), asks_(model_.size()) {
  for (const std::size_t track : expected.tracks()) {
    const auto number = static_cast<std::uint32_t>(owed_.size());
    const auto [channel, to, from] = model_.tracks()[track];
    asks_[from].asked.push_back(number);
    asks_[to].answered.push_back(number);
    const bool in_requests = expected.countsRequests(track);
    const double usual = in_requests ? 0 : expected.usualAnswer(track);
    owed_.push_back({track, to, in_requests, static_cast<std::int64_t>(usual), 0, 0});
  }
}

void OwedState::closeWindow(const Heard& heard, std::vector<double>& evidence) {
  for (const Answer& answer : owed_) {
    // Who was never heard is NeverHeard's matter.
    const bool owes = answer.requests > 0 && heard.hasSeen(answer.to);
    evidence[answer.track] = owes ? waiting(answer, heard) : 0;
  }
}

void OwedState::explain(std::size_t track, const Heard& heard, const RecentEvents& /*events*/,
                        Suspect& suspect) const {
  Reason& reason = suspect.reason;
  reason.kind = Kind::kSilent;
  reason.after = toString(model_.vocabulary().at(model_.tracks()[track].from));
  const Answer& answer = answerOf(track);
  char text[60];
  if (answer.in_requests) {
    reason.unit = unit::kRequests;
    reason.value = static_cast<double>(answer.requests);
    std::snprintf(text, sizeof text, "has not come after the last %u ", answer.requests);
  } else {
    reason.unit = unit::kSeconds;
    reason.value = answer.requests > 0 ? waiting(answer, heard) : 0;
    reason.lasted = reason.value;
    std::snprintf(text, sizeof text, "has not come for %.2f s after ", reason.value);
  }
  reason.words = text + reason.after;
}

}  // namespace

// Those that ask are ranked by how soon the answer comes.
std::vector<Track> Owed::watch(const Choice& choice) const {
  std::vector<Track> tracks;
  for (EventId to = 0; to < choice.both.size(); ++to) {
    std::vector<std::pair<std::size_t, EventId>> best;
    for (EventId from = 0; from < choice.both.size(); ++from) {
      const std::uint64_t answers = choice.both.answers(from, to);
      const double misses = missRate(choice.both.type(from).gaps, answers);
      if (from != to && !choice.isMode(from) && !choice.isMode(to) &&
          static_cast<double>(answers) >= choice.tuning.fewest_gaps &&
          misses <= choice.tuning.most_misses && choice.relations.owed(from, to).watched) {
        best.emplace_back(choice.both.delays(from, to).middle(0).last, from);
      }
    }
    std::sort(best.begin(), best.end());
    best.resize(std::min(best.size(), static_cast<std::size_t>(choice.tuning.deadlines)));
    for (const auto& [soon, from] : best) {
      tracks.push_back({this, to, from});
    }
  }
  return tracks;
}

std::unique_ptr<const Expectation> Owed::expect(const Model& model, const Halves& /*halves*/,
                                                std::vector<std::size_t> tracks) const {
  return std::make_unique<ExpectedAnswers>(model, std::move(tracks));
}

}  // namespace self_awareness::core::evidence
