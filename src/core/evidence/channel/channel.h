#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/evidence/count/starts.h"
#include "core/evidence/watch/gain.h"
#include "core/evidence/watch/heard.h"
#include "core/evidence/watch/recent_events.h"
#include "core/evidence/watch/relations.h"
#include "self_awareness/core/evidence/channel/track.h"
#include "self_awareness/core/evidence/count/halves.h"
#include "self_awareness/core/evidence/tuning.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::evidence {

class Model;

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// Its lines are for people, and come in bursts.
inline const std::string kLogTopic = "/rosout";

/// What a channel chooses its tracks by.
struct Choice {
  const Statistics& both;  ///< counts of both halves of the training
  const Gains& gains;
  const Relations& relations;
  const Tuning& tuning;

  /// Whether it is a mode of the robot (stream/mode.h). Nobody but Company looks at one.
  bool isMode(EventId id) const { return both.vocabulary().tellsMode(id); }
  /// Whether there are enough gaps of an event type to say something of it.
  bool isKnown(EventId id) const {
    return static_cast<double>(both.type(id).gaps) >= tuning.fewest_gaps;
  }
  /// Whether enough is known of an event type to judge it.
  bool isJudged(EventId id) const { return isKnown(id) && !isMode(id); }
  /// Whether the delays from `from` to `to` say enough of `to`.
  bool saysEnough(EventId from, EventId to) const {
    return gains(from, to) >= tuning.least_gain && !isMode(from) && !isMode(to);
  }
  /// Whether there are enough delays from one to another one.
  bool areEnough(EventId from, EventId to) const { return tuning.areEnough(both.total(from, to)); }
};

/// Evidence of one channel in a recording: what it must remember of the events.
class ChannelState {
 public:
  virtual ~ChannelState() = default;

  /// Whether add() does anything: it takes time with every event.
  virtual bool listens() const { return false; }
  /// Takes in an event of the model, before `heard` has it.
  virtual void add(const Heard::Arrival& /*arrival*/, const Heard& /*heard*/) {}
  /// Forgets what it knows of an event type: its component was restarted.
  virtual void disarm(EventId /*id*/) {}
  /// Forgets what its sums say of an event type: what was unusual so far was its start.
  virtual void forget(EventId /*id*/) {}
  /// Forgets what was heard.
  virtual void restart() {}
  /// Caps what it adds up a little above its limit: an alarm must not last much longer than its
  /// cause. Also knows then what is abnormal.
  /// @param limits by track of the model; NaN: not judged
  virtual void capAt(const std::vector<double>& /*limits*/) {}
  /// Sets the evidence of its tracks at the end of a window; 0: none.
  /// @param evidence by track of the model
  virtual void closeWindow(const Heard& heard, std::vector<double>& evidence) = 0;
  /// Since when what a track sees has been so [ns]; none: it does not know.
  virtual std::optional<std::int64_t> onset(std::size_t /*track*/) const { return std::nullopt; }
  /// By how much a track may exceed its limit, by what it has shown in operation [its unit];
  /// kUnlimited: it does not count.
  virtual double raisedBy(std::size_t /*track*/) const { return 0; }
  /// Whether further windows would say nothing new of a track that is beyond its limit.
  virtual bool isCertain(std::size_t /*track*/, double /*limit*/, const Heard& /*heard*/) const {
    return false;
  }
  /// Says why `to` of a track is a suspect: the numbers, and the words where the verdict has none.
  virtual void explain(std::size_t track, const Heard& heard, const RecentEvents& events,
                       Suspect& suspect) const = 0;
};

/// What a channel expects of its tracks. It is computed once from counts and never changes, so
/// threads may share it.
class Expectation {
 public:
  /// @param tracks of the model that are the channel's
  explicit Expectation(std::vector<std::size_t> tracks) : tracks_(std::move(tracks)) {}
  virtual ~Expectation() = default;

  const std::vector<std::size_t>& tracks() const { return tracks_; }
  /// Which of them, from 0 on, a track of the model is. In order: every window asks for those that
  /// are unusual.
  std::size_t numberOf(std::size_t track) const {
    return static_cast<std::size_t>(std::lower_bound(tracks_.begin(), tracks_.end(), track) -
                                    tracks_.begin());
  }
  /// The state at the start of a recording; this must outlive it.
  virtual std::unique_ptr<ChannelState> start() const = 0;
  /// Least limit that a track may have, in units of its evidence (docs/method.md, section 5.3).
  virtual double leastLimit(std::size_t track) const = 0;
  /// How long evidence takes to become so much, at the usual pace of the other event type [ns]; 0:
  /// not known, or there is no other one.
  virtual double timeUntil(std::size_t /*track*/, double /*evidence*/) const { return 0; }
  /// How much later than usual events must come, for a minute (Tuning::accept_after), to get
  /// beyond a limit [ns]; none: it is not about that, or no delay does.
  virtual std::optional<double> leastDelayFound(std::size_t /*track*/, double /*limit*/) const {
    return std::nullopt;
  }
  /// The limit of a track, in units of its evidence; NaN: of no use (docs/method.md, section 5.4).
  /// @param largest evidence that was seen
  /// @param most that is normal
  virtual double limit(std::size_t /*track*/, double /*largest*/, double most) const {
    return most;
  }

 private:
  std::vector<std::size_t> tracks_;
};

/// A kind of evidence (docs/method.md, section 3): all that the method knows of it. The list of
/// all is channels().
class Channel {
 public:
  virtual ~Channel() = default;

  /// In model files, and in Tuning::without.
  virtual std::string name() const = 0;
  /// As people read it.
  virtual std::string label() const { return name(); }
  virtual Finding finding() const = 0;
  /// What its tracks say is wrong, in general; explain() knows it exactly. Who accepts it accepts
  /// them (Acceptance::extent()).
  virtual Kind kind() const = 0;
  /// Whether it looks at attributes of messages (docs/method.md, section 3.10).
  virtual bool isOfAttributes() const { return false; }
  /// Whether a busy machine, or a slower clock, makes its tracks unusual: it looks at when
  /// messages come, and not at what they are, or who pauses.
  virtual bool mayBeLate() const { return !isOfAttributes(); }
  /// What it watches, given the counts of the training and the graph.
  virtual std::vector<Track> watch(const Choice& choice) const = 0;
  /// What it judges, in a word, where nothing else of an event type does; empty: another channel
  /// does.
  virtual std::string about() const { return {}; }
  /// Why it may not judge an event type, in words.
  virtual std::string whyNot(const Statistics& /*counts*/, EventId /*id*/,
                             const Tuning& /*tuning*/) const {
    return {};
  }
  /// What it expects of its tracks.
  /// @param halves of the training that the model is learned from
  virtual std::unique_ptr<const Expectation> expect(const Model& model, const Halves& halves,
                                                    std::vector<std::size_t> tracks) const = 0;
  /// What speaks for a track.
  /// @param as_usual recordings that were not trained on, in which its delays were as in training
  virtual Relation reason(const Track& /*track*/, const Relations& /*relations*/,
                          const std::vector<Span>& /*as_usual*/) const {
    Relation own;
    own.watched = true;  // what looks at one event type needs no reason
    return own;
  }
  /// Whether a recording can show that its delays mislead.
  virtual bool mayMislead() const { return false; }
};

}  // namespace self_awareness::core::evidence
