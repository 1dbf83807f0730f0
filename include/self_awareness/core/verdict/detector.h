#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "self_awareness/core/stream/mode.h"
#include "self_awareness/core/stream/windows.h"
#include "self_awareness/core/verdict/judge.h"
#include "self_awareness/core/verdict/persistence.h"
#include "self_awareness/core/verdict/shared_cause.h"
#include "self_awareness/core/verdict/source_graph.h"

namespace self_awareness::core {

/// What the detector says about one window.
struct Verdict {
  const Window* window = nullptr;   ///< valid during the handler's call
  std::optional<double> score;      ///< low is abnormal; none: the window has no score
  std::optional<double> threshold;  ///< s*; none: not calibrated
  bool abnormal = false;            ///< eq. 5, or silence, or unknown events that are an error
  bool settling = false;            ///< too early to say anything; the window does not count
  bool alarm = false;               ///< the alarm stands
  bool suspicion = false;           ///< no alarm, but something was abnormal recently
  /// The alarm or the suspicion began or ended with this window, there are new suspects, or the
  /// alarm is found to be of further computers.
  bool changed = false;
  std::string evidence;           ///< what made the window abnormal or suspicious, once settled
  std::optional<Busy> busy;       ///< of such a window: the machine, not the suspects
  std::optional<Silent> silent;   ///< of such a window: all, or all of some computers, are silent
  std::vector<std::string> mode;  ///< components that are off together, as is accepted, in order
  std::vector<Suspect> suspects;  ///< of an abnormal window that is not settling, best first
  /// Those of components that an alarm which stood before names for the first time: there may be
  /// another fault. One for each component.
  std::vector<Suspect> new_suspects;
  std::string waiting;  ///< who waits for the first suspect, as Judgement::waiting
  std::string note;  ///< what was found out about the one who is to blame, since; empty: nothing
};

/// What an event type means that training never saw (docs/method.md, section 4.5): somebody may
/// have plugged in a joystick. kWarn: it is told once, and then counted.
enum class UnknownEvents { kIgnore, kWarn, kError };

/// Turns events into alarms, in the same way live and from a bag: window, judgement, persistence
/// (docs/method.md, section 4).
class Detector : private WindowObserver {
 public:
  /// How events become alarms.
  struct Parameters {
    Persistence::Parameters persistence;    ///< how many abnormal windows make an alarm
    std::int64_t settle_time = 5000000000;  ///< after the first event, of all or of a type [ns]
    bool silence_is_abnormal = true;        ///< paper: a window without events scores 0
    UnknownEvents unknown = UnknownEvents::kWarn;  ///< a suspicion, or an alarm at once
  };
  /// Told the verdict on a window.
  using Handler = std::function<void(const Verdict&)>;

  /// @param window length [ns]
  /// @param handler called with the verdict on every window, in order; must not call the detector
  /// @throw std::invalid_argument if a parameter is out of range
  Detector(std::unique_ptr<Judge> judge, std::int64_t window, const Parameters& parameters,
           Handler handler);

  /// Takes in the next event. If the clock was set since the last one, the open window is dropped,
  /// and a new recording starts with this event.
  /// @return false if the clock was set
  bool add(const Event& event);
  /// Takes note of how the machine was in a stretch of time, one after the other; at the latest
  /// before a window is judged that ends after its begin. If who measured it stood still itself,
  /// and heard nothing, all but silence settles as at the start, for 3 s at least, and an alarm
  /// that stands goes on meanwhile.
  void hear(const Waiting& waiting);
  /// Takes what is accepted as normal from now on, in place of what was before. It is no unknown
  /// event any more, and no alarm of before the start waits for it.
  void accept(const Acceptances& accepted);
  /// Takes note which subscriptions are missing from now on; as Judge::setMissing().
  void setMissing(const std::set<SourceGraph::Subscription>& missing) {
    judge_->setMissing(missing);
  }
  /// Takes note of who sends from now on, as far as events do not say it.
  void setSenders(const Senders& senders) { judge_->setSenders(senders); }
  /// Takes note that this program was too slow, and has missed events of these types up to the
  /// time `now` [ns]: they settle as if they were new, for 3 s at least.
  void onMissed(const std::vector<EventId>& ids, std::int64_t now);
  /// Judges the windows that are over at the time `now` [ns], whether events came or not.
  void advance(std::int64_t now);
  /// Ends the recording and judges the open window.
  void finish();

  /// Forgets delays, windows and the alarm: the next event is the first.
  void restart();
  /// Forgets the alarm and the windows that led to it; the judge forgets nothing.
  void clearAlarm();

  /// An alarm stands that was raised before this program began. It ends as usual, but not before
  /// all have settled, and those of its suspects that had not come, or came late, were heard for
  /// as long as it takes to raise one. To be called before the first event.
  /// @param suspects of the alarm, with ids of known event types
  void resume(const std::vector<Suspect>& suspects);

  /// Whether an event has come since the start.
  bool started() const { return windows_.lastStamp().has_value(); }
  /// The mode that the robot is in, up to now [ns]; none: as Judge::mode().
  std::optional<LastingMode> mode(std::int64_t now) const { return judge_->mode(now); }
  /// As Judge::watchedLess().
  std::vector<WatchedLess> watchedLess() const { return judge_->watchedLess(); }
  /// Events since the start that training never saw, by id; without what is accepted.
  std::map<EventId, std::uint64_t> unknown() const;

 private:
  /// An event type that training never saw.
  struct Unknown {
    std::uint64_t events = 0;
    bool told = false;
  };
  /// A suspect of an alarm of before the start.
  struct Awaited {
    Kind kind = Kind::kSilent;          // what was wrong with it
    std::optional<std::int64_t> heard;  // for the first time [ns]
  };

  std::optional<ObservedEvent> observe(const Event& event) override;
  void close(const Window& window, std::int64_t end) override;
  void onClockStep() override;
  /// Some who stopped together are a new mode, and suspicious, after as many windows as raise an
  /// alarm: whom a busy machine held up come back within less.
  /// @param end of the window [ns]
  void leaveOutShortStops(Judgement& judgement, std::int64_t end);
  /// Takes a window that is not settling into account for the alarm and the suspicion.
  /// @param end of the window [ns]
  void count(const Judgement& judgement, std::int64_t end);
  /// Says of suspects since when their components are named.
  /// @param begins whether the alarm or the suspicion that stands began with this window: it names
  /// all of them; later only what is abnormal is named
  /// @param end of the window [ns]
  /// @return the first of each component that was not named before
  std::vector<Suspect> name(std::vector<Suspect>& suspects, bool begins, std::int64_t end);

  /// Whether unknown events of a window have to be told.
  bool isNews(const Window& window) const;
  /// They were told.
  void tellOnce(const Window& window);

  /// Whether the alarm of before the start has to stand on.
  /// @param end of the window [ns]
  bool awaitsSuspects(std::int64_t end) const;

  std::unique_ptr<Judge> judge_;
  Parameters parameters_;
  Handler handler_;
  Windows windows_;
  Persistence persistence_;
  Persistence new_mode_;  // of windows in which some are away who stopped together
  bool resumed_ = false;  // the alarm is that of before the start, and has to stand on
  std::map<EventId, Awaited> awaited_;  // its suspects that have to be heard
  std::size_t silent_ = 0;              // components that the alarm said are silent together
  bool suspicion_ = false;              // whether it stands
  std::int64_t suspicious_until_ = 0;   // [ns], while it stands
  std::int64_t settled_at_ = 0;         // [ns], valid once started
  std::int64_t resumed_at_ = 0;         // all has settled since this program stood still [ns]
  std::vector<bool> heard_;             // since the start, by id
  std::map<EventId, Unknown> unknown_;
  // When the alarm or the suspicion that stands named a component, or an event type whose
  // component is not known: end of the window [ns].
  std::map<std::pair<std::string, EventId>, std::int64_t> named_;
};

}  // namespace self_awareness::core
