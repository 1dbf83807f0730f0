#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "core/evidence/channel/channel.h"
#include "core/evidence/channel/scorer.h"
#include "self_awareness/core/evidence/channel/model.h"

namespace self_awareness::core::evidence {

/// Why no component is to blame for what is unusual; of several reasons, the first one counts.
enum class Excused {
  kAllSilent,    ///< all fell silent with it, or all of its computer
  kAccepted,     ///< somebody said that it is normal
  kNewMode,      ///< others stopped with it, which do not hear each other
  kSlowerClock,  ///< the simulation runs slower than in training
  kBusy,         ///< the machine has too little time for all
  kNo            ///< one may be to blame
};

constexpr std::int64_t kNotYet = std::numeric_limits<std::int64_t>::max();

/// That something is unusual: who, what, since when, how much (docs/method.md, section 6).
struct Excess {
  std::size_t track = 0;             ///< of the model
  const Channel* channel = nullptr;  ///< of the track: it says what is wrong with `id`
  EventId id = 0;
  EventId from = 0;           ///< as Track::from
  std::size_t component = 0;  ///< that `id` comes from, by its number
  std::int64_t onset = 0;     ///< since when what the channel sees has been so [ns]
  double share = 0;           ///< of its limit; above 1, it alone is abnormal
  Excused excused = Excused::kNo;
  /// Since the end of which window its share has been above 1 [ns]; kNotYet: it is not.
  std::int64_t abnormal = kNotYet;

  Finding finding() const { return channel->finding(); }
  /// Whether it says that something has not come.
  bool isAbsence() const { return evidence::isAbsence(finding()); }
  /// Whether it says that something has not come, or too seldom.
  bool isTooLittle() const { return isAbsence() || finding() == Finding::kFewer; }
};

/// Keeps what is unusual from one window to the next.
class Excesses {
 public:
  explicit Excesses(std::shared_ptr<const Model> model);

  /// Takes in a window.
  /// @param shares of their limits that the tracks of the model have reached
  /// @param scorer that has closed the window
  /// @return what is unusual in it, none of it excused, by track; valid until the next call
  std::vector<Excess>& closeWindow(const std::vector<double>& shares, const Scorer& scorer);
  /// Forgets what was unusual.
  void restart() { excesses_.clear(); }

 private:
  std::shared_ptr<const Model> model_;
  std::vector<Excess> excesses_;
};

}  // namespace self_awareness::core::evidence
