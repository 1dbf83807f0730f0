#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "self_awareness/core/stream/windows.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core {

/// What a judge says of one window.
struct Judgement {
  std::optional<double> score;      ///< low is abnormal; none: it says nothing of such a window
  std::optional<double> threshold;  ///< none: not calibrated
  bool abnormal = false;            ///< score < threshold (eq. 5), or silence
  bool certain = false;             ///< an alarm at once: what was found has lasted already
  bool suspicious = false;          ///< not abnormal, but on the way to it
  std::string evidence;             ///< what made the window abnormal or suspicious, in words
  std::vector<Suspect> suspects;    ///< if they were asked for; the first is the most likely
};

/// When a judge names those who may have made a window abnormal. Naming takes time.
enum class NameSuspects {
  kNever,
  kIfUnusual,  ///< of a window that is abnormal or suspicious
  kAlways      ///< whoever asks knows more than the judge
};

/// Judges the windows of one recording after its events came in: the method behind the detector.
class Judge {
 public:
  virtual ~Judge() = default;

  /// Takes in the next event; ids the model does not know are unknown events.
  virtual ObservedEvent add(const Event& event) = 0;
  /// Judges a window that is over: all events taken in since the window before. Without
  /// calibration it names no suspects.
  /// @param end of what is known of the window [ns], as of WindowObserver::close()
  virtual Judgement judge(const Window& window, std::int64_t end, NameSuspects suspects) = 0;
  /// Forgets what was seen: another recording, or the clock was set.
  virtual void restart() = 0;
};

}  // namespace self_awareness::core
