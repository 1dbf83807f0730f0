#include "core/evidence/channel/company.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "core/evidence/count/log_bins.h"
#include "core/evidence/watch/arming.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/stream/mode.h"

namespace self_awareness::core::evidence {
namespace {

/// Gaps of an event type that are pauses: so long that its silence alone would be found late.
struct Pauses {
  double longer_than = 0;  // [ns]
  double number = 0;
  double sum = 0;          // [ns]
  std::size_t starts = 0;  // that have some

  Pauses(const Statistics& counts, EventId id, const Tuning& tuning);
};

Pauses::Pauses(const Statistics& counts, EventId id, const Tuning& tuning)
    : longer_than(std::max(tuning.most_mean_gaps * counts.type(id).meanGap(),
                           1e9 * tuning.least_lateness)) {
  const std::vector<std::int64_t>& longest = counts.type(id).longest_gaps;
  if (longest.size() == Statistics::kLongestGaps) {  // there may be more of the shortest one
    longer_than = std::max(longer_than, static_cast<double>(longest.back()));
  }
  for (const std::int64_t gap : longest) {
    if (static_cast<double>(gap) > longer_than) {
      number += 1;
      sum += static_cast<double>(gap);
    }
  }
  std::vector<Span> spans;
  for (const Statistics::Recording& recording : counts.recordings()) {
    if (id < recording.longest_gaps.size() &&
        static_cast<double>(recording.longest_gaps[id]) > longer_than) {
      spans.push_back({recording.start, recording.end, recording.robot_start, recording.robot});
    }
  }
  starts = numberOfStarts(spans, toNanoseconds(tuning.start_time));
}

/// How much of the pauses of `id`, but for their begin, is not a pause of `other`: its events in
/// them, as the ages of `id` at them tell, and one more in each, of those that there would be by
/// chance.
double shareGoneOn(const Statistics& counts, EventId id, const Pauses& pauses, EventId other) {
  const DelayHistogram ages = counts.delays(id, other);
  double events = 0;
  for (std::size_t bin = ages.size(); bin-- > 0;) {
    events += ages[bin];
    if (static_cast<double>(log_bins::lowerEdge(bin)) < pauses.longer_than) {
      break;
    }
  }
  return (events + pauses.number) * counts.type(other).meanGap() /
         (pauses.sum - pauses.number * pauses.longer_than);
}

class ExpectedCompany : public Expectation {
 public:
  ExpectedCompany(const Model& model, std::vector<std::size_t> tracks)
      : Expectation(std::move(tracks)), model_(model) {
    for (const std::size_t track : this->tracks()) {
      const Pauses pauses(model.statistics(), model.tracks()[track].to, model.tuning());
      pauses_.push_back(static_cast<std::int64_t>(pauses.longer_than));
    }
  }

  std::unique_ptr<ChannelState> start() const override;
  double leastLimit(std::size_t track) const override {
    const double usual_gap = timeUntil(track, 1) * 1e-9;
    const Tuning& tuning = model_.tuning();
    // A hiccup of a host is no fault, however fast the other is.
    return std::max(tuning.least_requests,
                    usual_gap > 0 ? tuning.least_lateness / usual_gap : 0.0);
  }
  double timeUntil(std::size_t track, double evidence) const override {
    const EventId from = model_.tracks()[track].from;
    return evidence * (isMode(from) ? static_cast<double>(ModeTime::kTick)
                                    : model_.usualDelay(from, from, 0.5));
  }
  double limit(std::size_t track, double largest, double most) const override {
    const Track& watched = model_.tracks()[track];
    const double silence =
        model_.tuning().owed_of_silence * static_cast<double>(model_.longestSilence(watched.to));
    const double gap =
        isMode(watched.from) ? static_cast<double>(ModeTime::kTick) : model_.meanGap(watched.from);
    // Else it says no more than the silence by itself.
    return largest * gap < silence ? most : std::numeric_limits<double>::quiet_NaN();
  }
  bool isMode(EventId from) const { return model_.vocabulary().tellsMode(from); }
  /// Whether a gap [ns] of the `to` of a track, by number, is a pause.
  bool isPause(std::size_t number, std::int64_t gap) const { return gap > pauses_[number]; }
  const Model& model() const { return model_; }

 private:
  const Model& model_;
  std::vector<std::int64_t> pauses_;  // longer gaps are some [ns], by number
};

class CompanyState : public ChannelState {
 public:
  explicit CompanyState(const ExpectedCompany& expected);

  bool listens() const override { return !gone_on_.empty(); }
  void add(const Heard::Arrival& arrival, const Heard& heard) override {
    for (const std::uint32_t number : of_type_[arrival.id].to) {
      if (expected_.isPause(number, arrival.stamp - arrival.last_stamp)) {
        arming_[number].add(goneOn(number, heard), arming_numbers_);
      }
      arming_[number].come();
      gone_on_[number] = 0;
      if (is_mode_[number]) {
        lasted_[number] = heard.lasted(fromOf(number), arrival.stamp);
      }
    }
    if (arrival.stalled) {
      return;  // what waited comes all at once
    }
    for (const std::uint32_t number : of_type_[arrival.id].from) {
      ++gone_on_[number];
    }
  }
  void disarm(EventId id) override {
    for (const std::uint32_t number : of_type_[id].to) {
      arming_[number].forget();
    }
  }
  double raisedBy(std::size_t track) const override {
    return arming_[expected_.numberOf(track)].armed() ? 0 : kUnlimited;
  }
  void capAt(const std::vector<double>& limits) override {
    for (std::size_t number = 0; number < arming_.size(); ++number) {
      arming_[number].limitTo(limits[expected_.tracks()[number]]);
    }
  }
  void forget(EventId id) override {
    for (const auto* numbers : {&of_type_[id].to, &of_type_[id].from}) {
      for (const std::uint32_t number : *numbers) {
        gone_on_[number] = 0;
        forgotten_[number] = true;
      }
    }
  }
  void restart() override {
    std::fill(gone_on_.begin(), gone_on_.end(), 0);
    std::fill(lasted_.begin(), lasted_.end(), 0);
    std::fill(forgotten_.begin(), forgotten_.end(), false);
    std::for_each(arming_.begin(), arming_.end(), [](WaitArming& each) { each.restart(); });
  }
  void closeWindow(const Heard& heard, std::vector<double>& evidence) override;
  void explain(std::size_t track, const Heard& heard, const RecentEvents& events,
               Suspect& suspect) const override;

 private:
  /// Numbers of tracks: whose `to` an event type is, and whose `from`.
  struct OfType {
    std::vector<std::uint32_t> to;
    std::vector<std::uint32_t> from;
  };

  EventId fromOf(std::size_t number) const { return trackOf(number).from; }
  const Track& trackOf(std::size_t number) const {
    return expected_.model().tracks()[expected_.tracks()[number]];
  }
  /// What `from` said since the last `to`; of a mode, the ticks that it lasted, and parts of one.
  double goneOn(std::size_t number, const Heard& heard) const;

  const ExpectedCompany& expected_;
  std::int64_t start_time_;             // [ns]
  std::vector<std::uint32_t> gone_on_;  // `from` since the last `to`, by number
  std::vector<bool> is_mode_;           // whether `from` is one, by number
  // How long the mode had lasted at the last `to` [ns], by number; or, as soon as a window is
  // closed, by now.
  std::vector<std::int64_t> lasted_;
  std::vector<bool> forgotten_;
  const Arming::Numbers arming_numbers_;
  std::vector<WaitArming> arming_;  // by number
  std::vector<OfType> of_type_;     // by id
};

std::unique_ptr<ChannelState> ExpectedCompany::start() const {
  return std::make_unique<CompanyState>(*this);
}

CompanyState::CompanyState(const ExpectedCompany& expected)
    : expected_(expected),
      start_time_(toNanoseconds(expected.model().tuning().start_time)),
      gone_on_(expected.tracks().size(), 0),
      is_mode_(expected.tracks().size(), false),
      lasted_(expected.tracks().size(), 0),
      forgotten_(expected.tracks().size(), false),
      arming_numbers_(expected.model().tuning()),
      arming_(expected.tracks().size()),
      of_type_(expected.model().size()) {
  for (std::uint32_t number = 0; number < gone_on_.size(); ++number) {
    const Track& track = trackOf(number);
    of_type_[track.to].to.push_back(number);
    of_type_[track.from].from.push_back(number);
    is_mode_[number] = expected.isMode(track.from);
  }
}

double CompanyState::goneOn(std::size_t number, const Heard& heard) const {
  if (!is_mode_[number]) {
    return gone_on_[number];
  }
  const auto [channel, to, from] = trackOf(number);
  const std::int64_t since = heard.lastSeen(to).value_or(heard.start());
  // Who would have published all the time had stood still as well.
  const std::int64_t lasted =
      heard.lasted(from, heard.windowEnd()) - lasted_[number] - heard.stoodStillSince(since);
  return std::max(static_cast<double>(lasted) / static_cast<double>(ModeTime::kTick), 0.0);
}

void CompanyState::closeWindow(const Heard& heard, std::vector<double>& evidence) {
  const bool started = heard.windowEnd() - heard.start() >= start_time_;
  for (std::size_t number = 0; number < gone_on_.size(); ++number) {
    if (forgotten_[number] && is_mode_[number]) {
      lasted_[number] = heard.lasted(fromOf(number), heard.windowEnd());
    }
    forgotten_[number] = false;
    // Who was not heard yet may still be starting.
    const bool may_say = started || heard.hasSeen(trackOf(number).to);
    evidence[expected_.tracks()[number]] =
        may_say ? arming_[number].counted(goneOn(number, heard), arming_numbers_) : 0;
  }
}

void CompanyState::explain(std::size_t track, const Heard& heard, const RecentEvents& /*events*/,
                           Suspect& suspect) const {
  const std::size_t number = expected_.numberOf(track);
  const EventType& from = expected_.model().vocabulary().at(fromOf(number));
  Reason& reason = suspect.reason;
  reason.kind = Kind::kSilent;
  reason.after = toString(from);
  reason.value = goneOn(number, heard);
  char text[60];
  if (is_mode_[number]) {
    reason.unit = unit::kSeconds;
    std::snprintf(text, sizeof text, "has not come for %.3g s of the mode ", reason.value);
    reason.words = text + modeOf(from) + " (" + from.scope + "), in which it does not pause";
  } else {
    reason.unit = unit::kRequests;
    std::snprintf(text, sizeof text, "has not come with the last %.0f ", reason.value);
    reason.words = text + reason.after + ", which pauses when it does";
  }
}

}  // namespace

// Two that have nothing to do with each other would begin and end their pauses at one moment by
// chance. Both show how far they differ: what the one says while the other is silent. A mode lasts
// on when who told it has died, so it tells of the death of whoever hears it, or tells it.
std::vector<Track> Company::watch(const Choice& choice) const {
  const Statistics& counts = choice.both;
  std::vector<std::optional<Pauses>> pauses(counts.size());
  for (EventId id = 0; id < counts.size(); ++id) {
    const Pauses its(counts, id, choice.tuning);
    if (choice.isKnown(id) && its.starts >= 2) {
      pauses[id] = its;
    }
  }
  const auto component = [&](EventId id) {
    const EventType& type = counts.vocabulary().at(id);
    return componentOf(type.source, type.scope);
  };
  std::vector<Track> tracks;
  for (EventId to = 0; to < counts.size(); ++to) {
    std::vector<std::pair<double, EventId>> best;
    for (EventId from = 0; pauses[to] && !choice.isMode(to) && from < counts.size(); ++from) {
      const bool lasts = choice.isMode(from);
      if (!pauses[from] || (component(to) == component(from) && !lasts) ||
          counts.total(to, from) == 0 || counts.total(from, to) == 0) {
        continue;
      }
      const double of_to = shareGoneOn(counts, to, *pauses[to], from);
      const double of_from = shareGoneOn(counts, from, *pauses[from], to);
      const double chance =
          pauses[to]->number * std::log(of_to) + pauses[from]->number * std::log(of_from);
      if (of_to < 1 && of_from < 1 &&
          chance <= std::log(choice.tuning.chance / choice.relations.lookedAt()) &&
          (lasts || !choice.relations.owed(to, from).reaches)) {  // last, since this takes time
        best.emplace_back(of_to, from);
      }
    }
    std::sort(best.begin(), best.end());
    std::set<std::string> components;
    for (const auto& [found, from] : best) {
      if (choice.isMode(from) ||
          (components.size() < static_cast<std::size_t>(choice.tuning.deadlines) &&
           components.insert(component(from)).second)) {
        tracks.push_back({this, to, from});
      }
    }
  }
  return tracks;
}

std::unique_ptr<const Expectation> Company::expect(const Model& model, const Halves& /*halves*/,
                                                   std::vector<std::size_t> tracks) const {
  return std::make_unique<ExpectedCompany>(model, std::move(tracks));
}

}  // namespace self_awareness::core::evidence
