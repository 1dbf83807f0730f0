#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "core/evidence/channel/channel.h"
#include "core/evidence/channel/sum.h"
#include "self_awareness/core/evidence/channel/model.h"

namespace self_awareness::core::evidence {

/// What the channels of attributes have in common (docs/method.md, section 3.10): each looks at
/// the messages of one event type after the other, and at nothing else.

/// Whether training knows enough messages of an event type, and nearly all of its events.
inline bool knowsMessages(const Choice& choice, EventId id) {
  const AttributeCounts& counts = choice.both.type(id).attributes;
  return choice.isJudged(id) &&
         static_cast<double>(counts.counted()) >= choice.tuning.fewest_gaps &&
         static_cast<double>(counts.known()) >=
             choice.tuning.usual * static_cast<double>(choice.both.type(id).events);
}

/// The tracks of a channel for all event types that it supports.
/// @param supports given an event type
template <typename Supports>
std::vector<Track> tracksOfMessages(const Channel& channel, const Choice& choice,
                                    Supports supports) {
  std::vector<Track> tracks;
  for (EventId id = 0; id < choice.both.size(); ++id) {
    if (knowsMessages(choice, id) && supports(id)) {
      tracks.push_back({&channel, id, id});
    }
  }
  return tracks;
}

/// A source that is silent for longer than this [ns] pauses: its last messages say nothing of now.
inline std::int64_t pauseOf(const Model& model, EventId id) {
  return std::max(kRateSpan,
                  static_cast<std::int64_t>(model.tuning().most_mean_gaps * model.meanGap(id)));
}

/// What is expected of event types, by a class of what was heard of one. It has these members:
/// `Usual`, what is expected of it; add() of a message, with the most that it may add up to;
/// evidence(); explain().
template <typename Messages>
class ExpectedMessages : public Expectation {
 public:
  using Usual = typename Messages::Usual;

  /// @param usualOf called with each event type of the tracks
  template <typename UsualOf>
  ExpectedMessages(const Model& model, std::vector<std::size_t> tracks, UsualOf usualOf)
      : Expectation(std::move(tracks)), model_(model) {
    for (const std::size_t track : this->tracks()) {
      const EventId id = model.tracks()[track].to;
      usual_.push_back(usualOf(id));
      pauses_.push_back(pauseOf(model, id));
    }
  }

  std::unique_ptr<ChannelState> start() const override;
  double leastLimit(std::size_t track) const override { return usualOf(track).least_limit; }
  double limit(std::size_t track, double /*largest*/, double most) const override {
    return usualOf(track).is_supported ? most : std::numeric_limits<double>::quiet_NaN();
  }
  const Usual& usual(std::size_t number) const { return usual_[number]; }
  std::int64_t pause(std::size_t number) const { return pauses_[number]; }
  const Model& model() const { return model_; }

 private:
  const Usual& usualOf(std::size_t track) const { return usual_[numberOf(track)]; }

  const Model& model_;
  std::vector<Usual> usual_;          // by number
  std::vector<std::int64_t> pauses_;  // longer silences [ns], by number
};

template <typename Messages>
class MessagesState : public ChannelState {
 public:
  explicit MessagesState(const ExpectedMessages<Messages>& expected)
      : expected_(expected),
        number_of_(expected.model().size(), kNone),
        messages_(expected.tracks().size()),
        most_(expected.tracks().size(), std::numeric_limits<double>::infinity()) {
    for (std::uint32_t number = 0; number < messages_.size(); ++number) {
      number_of_[expected.model().tracks()[expected.tracks()[number]].to] = number;
    }
  }

  bool listens() const override { return true; }
  void add(const Heard::Arrival& arrival, const Heard& /*heard*/) override {
    const std::uint32_t number = number_of_[arrival.id];
    if (number != kNone && arrival.attributes.isKnown()) {
      messages_[number].add(arrival, expected_.usual(number), most_[number]);
    }
  }
  void disarm(EventId id) override { forget(id); }
  void forget(EventId id) override {
    if (number_of_[id] != kNone) {
      messages_[number_of_[id]] = {};
    }
  }
  void restart() override { messages_.assign(messages_.size(), {}); }
  void capAt(const std::vector<double>& limits) override {
    for (std::size_t number = 0; number < messages_.size(); ++number) {
      most_[number] = capOfSum(limits[expected_.tracks()[number]],
                               expected_.model().tuning().most_of_limit, most_[number]);
    }
  }
  void closeWindow(const Heard& heard, std::vector<double>& evidence) override {
    for (std::size_t number = 0; number < messages_.size(); ++number) {
      const std::size_t track = expected_.tracks()[number];
      const EventId id = expected_.model().tracks()[track].to;
      evidence[track] =
          heard.silence(id) > expected_.pause(number) ? 0 : messages_[number].evidence();
    }
  }
  void explain(std::size_t /*track*/, const Heard& /*heard*/, const RecentEvents& /*events*/,
               Suspect& suspect) const override {
    const std::uint32_t number = number_of_[suspect.id];
    messages_[number].explain(expected_.usual(number), suspect.reason);
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  const ExpectedMessages<Messages>& expected_;
  std::vector<std::uint32_t> number_of_;  // by id
  std::vector<Messages> messages_;        // by number
  std::vector<double> most_;              // that they may add up to, by number
};

template <typename Messages>
std::unique_ptr<ChannelState> ExpectedMessages<Messages>::start() const {
  return std::make_unique<MessagesState<Messages>>(*this);
}

}  // namespace self_awareness::core::evidence
