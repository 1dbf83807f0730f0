#include "core/evidence/channel/owed.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/evidence/channel/share.h"
#include "core/evidence/channel/sum.h"
#include "core/evidence/watch/arming.h"
#include "self_awareness/core/evidence/channel/model.h"

namespace self_awareness::core::evidence {
namespace {

class ExpectedAnswers : public Expectation {
 public:
  struct Answer {
    double usual = 0;  // a usual one takes no longer [ns]
    double step = 0;   // what a request without one adds to the sum [nat]; 0: in seconds
  };

  ExpectedAnswers(const Model& model, std::vector<std::size_t> tracks)
      : Expectation(std::move(tracks)), model_(model) {
    double missing = 0.5;  // as in missRate()
    double asked = 1;
    for (const std::size_t track : this->tracks()) {
      const Requests requests = requestsOf(track);
      missing += areSeries(track) ? 0 : requests.missed;
      asked += areSeries(track) ? 0 : requests.all;
    }
    const double rare = model_.tuning().rare;
    const bool fail = missing / asked > rare;  // those of this robot, now and then
    for (const std::size_t track : this->tracks()) {
      const Track& owed = model_.tracks()[track];
      const Requests requests = requestsOf(track);
      const double share = likelyShare(requests.missed + 0.5, requests.all + 1);
      const std::uint64_t gaps = model_.statistics().type(owed.from).gaps;
      const bool counts =
          fail || areSeries(track) ||
          missRate(gaps, model_.statistics().answers(owed.from, owed.to)) > tooSoon(owed) + rare;
      answers_.push_back({model_.usualDelay(owed.from, owed.to, (1 + model_.tuning().usual) / 2),
                          counts ? stepOfSum(1 / share, model_.tuning().least_sum) : 0});
    }
  }

  std::unique_ptr<ChannelState> start() const override;
  double leastLimit(std::size_t track) const override {
    const Tuning& tuning = model_.tuning();
    // What usual answers take is normal, also where no request before them counts.
    return answer(track).step > 0
               ? tuning.least_sum
               : std::max(tuning.least_lateness,
                          tuning.margin_of_waiting * 1e-9 * answer(track).usual);
  }
  double timeUntil(std::size_t track, double evidence) const override {
    const double step = answer(track).step;
    const double gap = model_.meanGap(model_.tracks()[track].from);
    return step > 0 ? (std::floor(evidence / step) + 1) * gap : evidence * 1e9;
  }
  double limit(std::size_t track, double largest, double most) const override {
    const EventId to = model_.tracks()[track].to;
    const bool says_more =
        timeUntil(track, largest) <
        model_.tuning().owed_of_silence * static_cast<double>(model_.longestSilence(to));
    return says_more && (answer(track).step == 0 || largest < kMostSum)
               ? most
               : std::numeric_limits<double>::quiet_NaN();
  }
  const Answer& answer(std::size_t track) const { return answers_[numberOf(track)]; }
  const Model& model() const { return model_; }

 private:
  /// Requests of training that an answer may be expected to, before the next one.
  struct Requests {
    double all = 0;
    double missed = 0;  // of them, without one
  };

  Requests requestsOf(std::size_t track) const {
    const Track& owed = model_.tracks()[track];
    const Statistics& counts = model_.statistics();
    const double all = static_cast<double>(counts.type(owed.from).gaps) * (1 - tooSoon(owed));
    return {all, std::max(all - static_cast<double>(counts.answers(owed.from, owed.to)), 0.0)};
  }
  bool areSeries(std::size_t track) const {
    return model_.meanGap(model_.tracks()[track].from) < static_cast<double>(kRateSpan);
  }
  /// Share of the requests that the next one follows before an answer may be expected.
  double tooSoon(const Track& owed) const {
    const DelayHistogram& gaps = model_.statistics().delays(owed.from, owed.from);
    const std::size_t latest =
        model_.statistics().delays(owed.from, owed.to).middle(model_.tuning().usual).last;
    double shorter = 0;
    for (std::size_t bin = 0; bin <= latest; ++bin) {
      shorter += gaps[bin];
    }
    return shorter / static_cast<double>(std::max<std::uint64_t>(gaps.total(), 1));
  }

  const Model& model_;
  std::vector<Answer> answers_;  // by number of the track
};

class OwedState : public ChannelState {
 public:
  explicit OwedState(const ExpectedAnswers& expected);

  bool listens() const override { return !owed_.empty(); }
  void add(const Heard::Arrival& arrival, const Heard& heard) override {
    for (const std::uint32_t number : asks_[arrival.id].answered) {
      answer(owed_[number], arrival.stamp);
    }
    if (arrival.stalled) {
      return;  // what waited comes all at once, before any answer to it
    }
    for (const std::uint32_t number : asks_[arrival.id].asked) {
      ask(owed_[number], arrival.stamp, heard);
    }
  }
  void disarm(EventId id) override {
    for (const std::uint32_t number : asks_[id].answered) {
      owed_[number].arming.forget();
    }
  }
  void restart() override {
    for (Answer& answer : owed_) {
      answer.requests = 0;
      answer.sum.value = 0;
      answer.arming.restart();
    }
  }
  void capAt(const std::vector<double>& limits) override {
    for (Answer& answer : owed_) {
      answer.arming.limitTo(limits[answer.track]);
      answer.sum.capAt(limits[answer.track], model_.tuning().most_of_limit);
    }
  }
  void closeWindow(const Heard& heard, std::vector<double>& evidence) override;
  double raisedBy(std::size_t track) const override {
    return answerOf(track).arming.armed() ? 0 : kUnlimited;
  }
  std::optional<std::int64_t> onset(std::size_t track) const override {
    const Answer& answer = answerOf(track);
    return answer.requests > 1 || answer.step == 0 ? answer.since : answer.sum.since;
  }
  void explain(std::size_t track, const Heard& heard, const RecentEvents& events,
               Suspect& suspect) const override;

 private:
  struct Answer {
    std::size_t track = 0;
    EventId to = 0;
    std::int64_t usual = 0;      // a usual answer takes no longer [ns]
    double step = 0;             // what a request without an answer adds [nat]; 0: in seconds
    std::uint32_t requests = 0;  // since the last answer
    std::int64_t since = 0;      // stamp of the first of them [ns], if there is one
    std::int64_t last = 0;       // stamp of the last of them
    CountedSum sum;              // of requests; unusual: without an answer
    WaitArming arming;           // in seconds
  };
  /// Numbers of answers: that an event type asks for, and that it is.
  struct OfType {
    std::vector<std::uint32_t> asked;
    std::vector<std::uint32_t> answered;
  };

  const Answer& answerOf(std::size_t track) const { return owed_[expected_.numberOf(track)]; }
  static double waiting(const Answer& answer, const Heard& heard) {
    return answer.requests > 0 ? toSeconds(heard.windowEnd() - answer.since) : 0;
  }
  void answer(Answer& answer, std::int64_t stamp) const;
  void ask(Answer& answer, std::int64_t stamp, const Heard& heard) const;

  const ExpectedAnswers& expected_;
  const Model& model_;
  const Arming::Numbers arming_numbers_;
  std::vector<Answer> owed_;
  std::vector<OfType> asks_;  // by id
};

std::unique_ptr<ChannelState> ExpectedAnswers::start() const {
  return std::make_unique<OwedState>(*this);
}

OwedState::OwedState(const ExpectedAnswers& expected)
    : expected_(expected),
      model_(expected.model()),
      arming_numbers_(model_.tuning()),
      asks_(model_.size()) {
  for (const std::size_t track : expected.tracks()) {
    const auto number = static_cast<std::uint32_t>(owed_.size());
    const auto [channel, to, from] = model_.tracks()[track];
    asks_[from].asked.push_back(number);
    asks_[to].answered.push_back(number);
    for (const EventId other : model_.inPlaceOf(to)) {
      if (other != from) {
        asks_[other].answered.push_back(number);
      }
    }
    Answer& answer = owed_.emplace_back();
    answer.track = track;
    answer.to = to;
    answer.usual = static_cast<std::int64_t>(expected.answer(track).usual);
    answer.step = expected.answer(track).step;
  }
}

void OwedState::answer(Answer& answer, std::int64_t stamp) const {
  if (answer.step > 0 && answer.requests > 0) {
    answer.sum.count(false, answer.step, stamp);
  } else if (answer.step > 0) {
    answer.sum.add(-answer.step, stamp);  // the one before was only late
  }
  if (answer.requests > 0) {
    answer.arming.add(toSeconds(stamp - answer.since), arming_numbers_);
    answer.arming.come();
  }
  answer.requests = 0;
}

void OwedState::ask(Answer& answer, std::int64_t stamp, const Heard& heard) const {
  const std::optional<std::int64_t> answered = heard.lastSeen(answer.to);
  if (answer.step > 0) {
    // Who was never heard is NeverHeard's matter.
    if (answer.requests > 0 && stamp - answer.last >= answer.usual && answered) {
      answer.sum.count(true, answer.step, answer.last);
    }
  } else if (answered && stamp - *answered < answer.usual) {
    return;  // two that answer to the same come in any order: it may have come already
  }
  answer.since = answer.requests > 0 ? answer.since : stamp;
  answer.last = stamp;
  ++answer.requests;
}

void OwedState::closeWindow(const Heard& heard, std::vector<double>& evidence) {
  for (Answer& answer : owed_) {
    const double seconds = heard.hasSeen(answer.to) ? waiting(answer, heard) : 0;
    evidence[answer.track] =
        answer.step > 0 ? answer.sum.value : answer.arming.counted(seconds, arming_numbers_);
  }
}

void OwedState::explain(std::size_t track, const Heard& heard, const RecentEvents& /*events*/,
                        Suspect& suspect) const {
  Reason& reason = suspect.reason;
  reason.kind = Kind::kSilent;
  reason.after = toString(model_.vocabulary().at(model_.tracks()[track].from));
  const Answer& answer = answerOf(track);
  char text[80];
  if (answer.step == 0) {
    reason.unit = unit::kSeconds;
    reason.value = waiting(answer, heard);
    reason.lasted = reason.value;
    std::snprintf(text, sizeof text, "has not come for %.2f s after ", reason.value);
  } else {
    reason.unit = unit::kRequests;
    const bool at_all = answer.sum.unusual < answer.sum.events;
    reason.value = at_all ? answer.sum.unusual : answer.requests;
    at_all ? std::snprintf(text, sizeof text, "has not come after %u of the last %u ",
                           answer.sum.unusual, answer.sum.events)
           : std::snprintf(text, sizeof text, "has not come after the last %u ", answer.requests);
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
          misses <= choice.tuning.most_unusual && choice.relations.owed(from, to).watched) {
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
