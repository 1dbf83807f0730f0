#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/verdict/detector.h"
#include "self_awareness/core/verdict/shared_cause.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core {

/// A stretch of time in which the alarm stood, or a suspicion: when, who, and why. It keeps its
/// id. It keeps its culprit, whoever is named later, unless what is wrong with that one began
/// before; if the machine turns out to be busy, or everybody (on the culprit's computer) silent,
/// there is no culprit any more.
struct Alarm {
  /// How sure it is: WARN or ERROR in diagnostics.
  enum class Level { kSuspicion, kAlarm };

  /// Its begin, or one more than the id of the one before if that is larger: unique in a stream,
  /// and the same live and in a recording of it.
  std::uint64_t id = 0;
  Level level = Level::kSuspicion;  ///< the same from its begin to its end
  std::int64_t begin = 0;           ///< end of the window that raised it [ns]
  std::int64_t end = 0;       ///< end of the window that ended it, or of the last one so far [ns]
  bool over = false;          ///< false: it stands
  Kind kind = Kind::kSilent;  ///< what is wrong, of the culprit or of all
  std::string culprit;        ///< component; empty: there is none, or nobody stands out
  /// Why the culprit is one, in words; without a culprit: who is silent, or empty.
  std::string reason;
  std::string note;  ///< what was found out about the culprit since, in words; empty: nothing
  /// Who waits for the culprit, who for them, and so on, at most, in words; empty: nobody, or it
  /// is not known.
  std::string waiting;
  /// What raised it, in words; empty: a suspicion that an alarm left, so far. That is about the
  /// same component as the alarm, until something else is abnormal.
  std::string evidence;
  /// Of its windows and the one that ended it; a window without a score counts as 0.
  double lowest_score = std::numeric_limits<double>::quiet_NaN();
  std::optional<Busy> busy;      ///< as the first window said that does
  std::optional<Silent> silent;  ///< as the window said with most components
  /// Of the window that raised it, the most likely first; of a suspicion that an alarm left, its
  /// culprit. Their components are known, also those of strangers.
  std::vector<Suspect> suspects;
  std::vector<Suspect> later;  ///< of further components, each with its time (since)

  /// Whether it tells of what is new once, however long that lasts.
  bool isToldOnce() const { return level == Level::kSuspicion && evidence == kUnknownEvents; }
  /// The suspect that is the culprit; null: there is none.
  const Suspect* suspectToBlame() const;
};

/// Makes alarms and suspicions of the verdicts on one window after the other, in the same way live
/// and from a bag.
class Alarms {
 public:
  /// Takes in the verdict on the next window.
  /// @param window its length [ns]
  /// @param vocabulary that the suspects' ids are of; the components of unknown events are in it
  /// @return the alarm or suspicion that ended with this window; none: nothing ended
  std::optional<Alarm> add(const Verdict& verdict, std::int64_t window,
                           const Vocabulary& vocabulary);
  /// Ends what stands for another reason than a window.
  /// @param now [ns]
  /// @return what stood; none: nothing did
  std::optional<Alarm> end(std::int64_t now);
  /// Goes on with an alarm of before the start.
  void resume(Alarm alarm);
  /// The alarm or suspicion that stands; none: all is normal.
  const std::optional<Alarm>& standing() const { return standing_; }

 private:
  void begin(const Verdict& verdict, std::int64_t end, const std::optional<Alarm>& before);
  void goOn(const Verdict& verdict, std::int64_t end, const Vocabulary& vocabulary);

  std::optional<Alarm> standing_;
  std::uint64_t last_id_ = 0;
};

}  // namespace self_awareness::core
