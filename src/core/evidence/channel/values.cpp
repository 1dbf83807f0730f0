#include "core/evidence/channel/values.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <utility>

#include "core/evidence/channel/share.h"
#include "core/evidence/channel/sum.h"
#include "core/evidence/channel/topic_values.h"
#include "self_awareness/core/evidence/channel/model.h"

namespace self_awareness::core::evidence {
namespace {

/// All values of a sender on a topic, and how many messages had one of them.
struct Topic {
  std::vector<EventId> ids;
  std::uint64_t messages = 0;
};

/// All topics of a few values: who has more says what it likes.
std::vector<Topic> topicsIn(const Statistics& counts, const Tuning& tuning) {
  std::vector<Topic> all;
  for (auto& [type, ids] : valuesByTopic(counts.vocabulary())) {
    if (type.scope != kLogTopic && static_cast<double>(ids.size()) <= tuning.most_values) {
      Topic& topic = all.emplace_back();
      for (const EventId id : ids) {
        topic.messages += counts.type(id).events;
      }
      topic.ids = std::move(ids);
    }
  }
  return all;
}

/// The largest share that is likely; 1: there is no message.
double shareOf(const Statistics& counts, EventId id, const Topic& topic) {
  return topic.messages == 0 ? 1
                             : likelyShare(static_cast<double>(counts.type(id).events),
                                           static_cast<double>(topic.messages));
}

class ExpectedShares : public Expectation {
 public:
  struct Usual {
    double share = 0;  // that is likely, at most
    double more = 0;   // what a message with the value adds to the sum [nat]
    double least_limit = 0;
    std::int64_t pause = 0;  // after which what was said before says nothing of now [ns]
  };

  ExpectedShares(const Model& model, std::vector<std::size_t> tracks)
      : Expectation(std::move(tracks)), model_(model), usual_(this->tracks().size()) {
    numbers_of_.resize(model.size());
    for (const Topic& topic : topicsIn(model.learned(), model.tuning())) {
      double an_hour = 0;
      std::int64_t pause = std::numeric_limits<std::int64_t>::max();
      for (const EventId id : topic.ids) {
        const bool is_known = model.learned().type(id).gaps > 0;
        an_hour += kNanosecondsPerHour /
                   std::max(is_known ? model.meanGap(id) : kNanosecondsPerHour, 1.0);
        pause = is_known ? std::min(pause, model.longestGap(id)) : pause;
      }
      for (std::size_t number = 0; number < this->tracks().size(); ++number) {
        const EventId of_track = model.tracks()[this->tracks()[number]].to;
        if (std::find(topic.ids.begin(), topic.ids.end(), of_track) == topic.ids.end()) {
          continue;
        }
        Usual& usual = usual_[number];
        usual.share =
            std::min(shareOf(model.learned(), of_track, topic), model.tuning().most_unusual);
        usual.more = stepOfSum(1 / usual.share, model.tuning().least_sum);
        usual.least_limit = leastLimitOfSum(an_hour / 2, model.tuning());
        usual.pause = std::max(kRateSpan, pause);
        for (const EventId id : topic.ids) {
          numbers_of_[id].push_back(number);
        }
      }
    }
  }

  std::unique_ptr<ChannelState> start() const override;
  double leastLimit(std::size_t track) const override {
    return usual_[numberOf(track)].least_limit;
  }
  double limit(std::size_t /*track*/, double largest, double most) const override {
    return limitOfSum(largest, most);
  }
  const Model& model() const { return model_; }
  const Usual& usual(std::size_t number) const { return usual_[number]; }
  /// The tracks that a message of an event type says something of, by number.
  const std::vector<std::size_t>& numbersOf(EventId id) const { return numbers_of_[id]; }

 private:
  const Model& model_;
  std::vector<Usual> usual_;                          // by number of the track
  std::vector<std::vector<std::size_t>> numbers_of_;  // by id
};

class SharesState : public ChannelState {
 public:
  explicit SharesState(const ExpectedShares& expected)
      : expected_(expected), values_(expected.tracks().size()) {}

  bool listens() const override { return !values_.empty(); }
  void add(const Heard::Arrival& arrival, const Heard& /*heard*/) override {
    for (const std::size_t number : expected_.numbersOf(arrival.id)) {
      const ExpectedShares::Usual& usual = expected_.usual(number);
      OfValue& value = values_[number];
      const bool has_it = expected_.model().tracks()[expected_.tracks()[number]].to == arrival.id;
      value.sum.count(has_it, usual.more, arrival.stamp);
      value.last = arrival.stamp;
    }
  }
  void forget(EventId id) override {
    for (const std::size_t number : expected_.numbersOf(id)) {
      values_[number].sum.value = 0;
    }
  }
  void restart() override {
    for (OfValue& value : values_) {
      value.sum.value = 0;
    }
  }
  void capAt(const std::vector<double>& limits) override {
    for (std::size_t number = 0; number < values_.size(); ++number) {
      values_[number].sum.capAt(limits[expected_.tracks()[number]],
                                expected_.model().tuning().most_of_limit);
    }
  }
  void closeWindow(const Heard& heard, std::vector<double>& evidence) override {
    for (std::size_t number = 0; number < values_.size(); ++number) {
      const OfValue& value = values_[number];
      const bool lasts = heard.windowEnd() - value.last <= expected_.usual(number).pause;
      evidence[expected_.tracks()[number]] = lasts ? value.sum.value : 0;
    }
  }
  std::optional<std::int64_t> onset(std::size_t track) const override {
    return values_[expected_.numberOf(track)].sum.since;
  }
  void explain(std::size_t track, const Heard& /*heard*/, const RecentEvents& /*events*/,
               Suspect& suspect) const override {
    const OfValue& value = values_[expected_.numberOf(track)];
    const double usual = expected_.usual(expected_.numberOf(track)).share;
    Reason& reason = suspect.reason;
    reason.kind = Kind::kFast;
    reason.unit = "share";
    reason.value =
        value.sum.events > 0 ? static_cast<double>(value.sum.unusual) / value.sum.events : 0;
    reason.usual = usual;
    reason.usual_shortest = 0;
    reason.usual_longest = usual;
    char text[100];
    std::snprintf(text, sizeof text, "%u of the last %u messages, usually %.1f %% at most",
                  value.sum.unusual, value.sum.events, 100 * usual);
    reason.words = text;
  }

 private:
  struct OfValue {
    CountedSum sum;         // of messages; unusual: with the value
    std::int64_t last = 0;  // stamp of the last message [ns]
  };

  const ExpectedShares& expected_;
  std::vector<OfValue> values_;  // by number of the track
};

std::unique_ptr<ChannelState> ExpectedShares::start() const {
  return std::make_unique<SharesState>(*this);
}

}  // namespace

std::vector<Track> Values::watch(const Choice& choice) const {
  std::vector<Track> tracks;
  for (const Topic& topic : topicsIn(choice.both, choice.tuning)) {
    for (const EventId id : topic.ids) {
      if (topic.ids.size() > 1 && shareOf(choice.both, id, topic) < choice.tuning.most_unusual) {
        tracks.push_back({this, id, id});
      }
    }
  }
  return tracks;
}

std::unique_ptr<const Expectation> Values::expect(const Model& model, const Halves& /*halves*/,
                                                  std::vector<std::size_t> tracks) const {
  return std::make_unique<ExpectedShares>(model, std::move(tracks));
}

}  // namespace self_awareness::core::evidence
