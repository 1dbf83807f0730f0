#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "self_awareness/core/evidence/channel/model.h"

namespace self_awareness::core::evidence {

/// Remembers the last events of a recording, and says what the sum of a delay or answer track has
/// seen since it was 0 last (docs/method.md, section 6). The Scorer keeps nothing but the sums:
/// every event costs time there, and only suspects need more.
class Hindsight {
 public:
  /// So many events are remembered, of 16 bytes each: minutes of a small robot, seconds of a large
  /// one.
  static constexpr std::size_t kMostEvents = 1U << 15U;

  /// Delays since the sum was 0 last.
  struct Delays {
    std::int64_t since = 0;   ///< stamp of the event with the first one [ns]
    std::size_t number = 0;   ///< at least 1
    std::size_t unusual = 0;  ///< those that added to the sum
    double delay = 0;         ///< median of the unusual ones, or of all if none is unusual [ns]
    double usual = 0;         ///< median of the delays before; of training if there were few [ns]
    /// Set if some of the unusual ones were shorter than the usual one, and some longer: the
    /// median of how far they were from it [ns].
    std::optional<double> scatter;
  };
  /// Answers since the sum was 0 last.
  struct Answers {
    std::int64_t since = 0;  ///< stamp of the first event without answer [ns]
    std::size_t asked = 0;   ///< at least 1
    std::size_t missed = 0;  ///< answers that did not come
  };

  explicit Hindsight(std::shared_ptr<const Model> model);

  /// @param event ignored if the model does not know its id
  void add(const Event& event);
  /// Forgets what was seen: a new recording starts, or the clock was set.
  void restart();

  /// @param track a delay track
  /// @param cap of its sum
  /// @return none if there was no delay
  std::optional<Delays> delays(std::size_t track, double cap) const;
  /// @param track an answer track
  /// @param cap of its sum
  /// @return none if the sum is 0
  std::optional<Answers> answers(std::size_t track, double cap) const;

 private:
  struct Remembered {
    std::int64_t stamp = 0;  // [ns]
    EventId id = 0;
    std::uint32_t before = 0;  // so many events before came the last one of its type; 0: none
  };

  bool isRemembered(std::uint64_t number) const {
    return number > 0 && number_ - number < kMostEvents;
  }
  /// Number of the event of the same type before one that is remembered; 0: none is.
  std::uint64_t before(std::uint64_t number) const;
  /// The events of two types that are remembered, the oldest first.
  std::vector<Event> eventsOf(EventId a, EventId b) const;

  std::shared_ptr<const Model> model_;
  std::vector<Remembered> events_;   // by number, modulo kMostEvents
  std::uint64_t number_ = 0;         // of the last event, from 1; 0: there was none
  std::vector<std::uint64_t> last_;  // number of the last event, by id; 0: there was none
};

}  // namespace self_awareness::core::evidence
