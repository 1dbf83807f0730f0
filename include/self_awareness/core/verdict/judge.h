#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "self_awareness/core/stream/mode.h"
#include "self_awareness/core/stream/waiting.h"
#include "self_awareness/core/stream/windows.h"
#include "self_awareness/core/verdict/acceptance.h"
#include "self_awareness/core/verdict/senders.h"
#include "self_awareness/core/verdict/shared_cause.h"
#include "self_awareness/core/verdict/source_graph.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core {

/// What a window with event types that training never saw is suspicious for.
constexpr char kUnknownEvents[] = "unknown events";

/// What a judge says about one window.
struct Judgement {
  std::optional<double> score;      ///< low is abnormal; none: such a window has no score
  std::optional<double> threshold;  ///< none: not calibrated
  bool abnormal = false;            ///< score < threshold (eq. 5), or silence
  bool certain = false;             ///< an alarm at once (docs/method.md, section 4.3)
  bool suspicious = false;          ///< not abnormal, but on the way to it
  bool settling = false;            ///< too much is new to say anything of the whole window
  std::string evidence;             ///< what made the window abnormal or suspicious, in words
  /// Set if many components are late at once: the suspects are hardly to blame.
  std::optional<Busy> busy;
  /// Set if everybody, or everybody on some computers, should have been heard by now; not told by
  /// the paper's detector.
  std::optional<Silent> silent;
  /// Components that are off together, as somebody has accepted, in order (docs/live.md).
  std::vector<std::string> mode;
  /// If they were asked for; the most likely first. After kMostSuspects, further components whose
  /// evidence alone is abnormal may follow.
  std::vector<Suspect> suspects;
  /// Where the first suspect is silent, who waits for it (waitingFor()).
  std::string waiting;
};

/// What is watched less than was calibrated, by what it has shown since (docs/method.md, section
/// 3.7): who pauses; or delays, which do not count until they have been as in training.
struct WatchedLess {
  EventId id = 0;     ///< the event type that comes
  EventId after = 0;  ///< the one that it comes after; itself: it pauses
  double limit = 0;   ///< of its silence, now [s]; infinite: its delays do not count
};

/// Of which windows a judge names suspects: naming them takes time.
enum class NameSuspects {
  kNever,
  kIfUnusual,  ///< of windows that are abnormal or suspicious
  kAlways      ///< of all windows: the caller knows more than the judge
};

/// Takes in the events of a recording and judges its windows: the method that the detector uses.
class Judge {
 public:
  virtual ~Judge() = default;

  /// Takes in the next event. One with an id that the model does not know is an unknown event.
  /// @return none: it is no event of a window, but tells the mode of the robot (stream/mode.h)
  virtual std::optional<ObservedEvent> add(const Event& event) = 0;
  /// Takes note that an event type is heard for the first time in the recording: what is unusual
  /// of it meanwhile is its start (docs/method.md, section 4.4).
  /// @param first event of the type, which add() follows
  /// @param settle_time from the event on [ns]
  virtual void settle(const Event& first, std::int64_t settle_time) = 0;
  /// Takes note that events of these types were missed: what is unusual of them up to `until` [ns]
  /// says nothing of who sends them. If they tell a mode, it is not known any more.
  virtual void leaveOut(const std::vector<EventId>& ids, std::int64_t until) = 0;
  /// The mode that the robot is in, up to now [ns], whether the model knows it or not; none: it is
  /// not known, or this judge knows no modes.
  virtual std::optional<LastingMode> mode(std::int64_t /*now*/) const { return std::nullopt; }
  /// What is watched less now. A judge that learns nothing in operation has none.
  virtual std::vector<WatchedLess> watchedLess() const { return {}; }
  /// Takes note that this program stood still: what came meanwhile was received late, or never.
  /// What is unusual up to `until` [ns] says nothing; who was silent before is silent still.
  /// @param pause told in place of hear()
  virtual void standStill(const Waiting& pause, std::int64_t until) = 0;
  /// Takes note of how the machine was in a stretch of time, one after the other. Who does not
  /// judge by time has no use for it.
  virtual void hear(const Waiting& /*waiting*/) {}
  /// Takes what is accepted as normal from now on, in place of what was before. Who knows no event
  /// type of its own has no use for it.
  virtual void accept(const Acceptances& /*accepted*/) {}
  /// Whether something that an event type does is accepted, or it may be absent and is.
  virtual bool isAccepted(EventId /*id*/, Kind /*kind*/) const { return false; }
  /// Takes note of all subscriptions that every start of the training had and that are missing
  /// from now on, although the source is known to the master. Who judges by events alone has no
  /// use for it.
  virtual void setMissing(const std::set<SourceGraph::Subscription>& /*missing*/) {}
  /// Takes note of who sends from now on, as far as events do not say it. Who judges by events
  /// alone has no use for it.
  virtual void setSenders(const Senders& /*senders*/) {}
  /// Judges a window that is over. Its events are all those taken in since the window before it.
  /// Without calibration, the judge names no suspects.
  /// @param end up to where the window is known [ns], as for WindowObserver::close()
  virtual Judgement judge(const Window& window, std::int64_t end, NameSuspects suspects) = 0;
  /// Forgets what was seen: a new recording starts, or the clock was set.
  virtual void restart() = 0;
};

}  // namespace self_awareness::core
