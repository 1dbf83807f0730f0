#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "self_awareness/EventLog.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/stream/waiting.h"

namespace self_awareness::ros1 {

/// Packs the events of one recording into the parts of an event log (docs/bags.md).
class EventLogPacker {
 public:
  /// A part is handed out when it lasts this long [ns]: what is lost in a crash is no more.
  static constexpr std::int64_t kLongestPart = 20 * core::kNanosecondsPerSecond;
  static constexpr std::size_t kMostEvents = 1U << 15U;  ///< of a part

  using Handler = std::function<void(self_awareness::EventLog)>;

  /// @param handler called with each part in turn, but without its number and events_before
  explicit EventLogPacker(Handler handler) : handler_(std::move(handler)) {}

  /// Takes in the next event, at 0 ns or later.
  /// @param vocabulary that its id is of; it may grow, but ids keep their meaning
  void add(const core::Event& event, const core::Vocabulary& vocabulary);
  /// Takes in how the machine was in the stretch of time after the one before.
  void add(const core::Waiting& waiting) { waiting_.push_back(waiting); }
  /// Says how many messages were dropped since listening began.
  void setDropped(std::uint64_t messages) { dropped_ = messages; }
  /// Says that nothing else was heard before `now` [ns]; hands out the open part if it has lasted
  /// long enough.
  void advance(std::int64_t now);
  /// Hands out the open part, even if it holds no event.
  /// @param now [ns] up to which all was heard
  void flush(std::int64_t now);

 private:
  Handler handler_;
  std::vector<std::optional<core::EventId>> ids_;  // in the log, by id of the vocabulary
  core::EventId known_ = 0;                        // event types in the log
  std::vector<core::Event> events_;                // of the open part, by ids of the log
  std::vector<self_awareness::EventType> new_types_;
  std::optional<std::int64_t> begin_;   // of the open part [ns]
  std::vector<core::Waiting> waiting_;  // of the open part
  std::uint64_t dropped_ = 0;
};

}  // namespace self_awareness::ros1
