#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "alarm_state.h"
#include "diagnostic_status.h"
#include "heard_tally.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/verdict/detector.h"
#include "self_awareness/ros/bag/bag_writer.h"

namespace self_awareness::ros1 {

/// A bag of what the monitor would have published of recordings, as if it had been recorded with
/// them: /self_awareness/status, /self_awareness/alarm (latching) and /diagnostics. Its version
/// (kVersionTopic) comes first.
///
/// All methods that write throw BagError if that fails.
class ResultBag {
 public:
  /// Name of the node that the messages seem to come from, without the leading slash.
  static constexpr char kNode[] = "self_awareness";

  /// Creates the file, or empties the one that is there. Without close() it is of no use.
  /// @param named what errors call the file; empty: by its path
  explicit ResultBag(const std::string& path, const std::string& named = "");

  /// @param now recording time of the message [ns]; times before 1970 count as 1970
  template <typename Message>
  void write(const std::string& topic, std::int64_t now, const Message& message,
             bool latching = false);
  /// Completes the file; nothing may be written after that.
  void close() { bag_.close(); }

  /// Whether a file is a whole bag that this class wrote, so that nothing is lost if it is written
  /// again: not a recording, although one may have the same topics.
  static bool isOne(const std::string& path);

 private:
  BagWriter bag_;
  bool tells_version_ = false;  // what has been written says it
};

/// What the monitor would have said while a recording was made: it hears the events and verdicts
/// of a detector that judges the recording, and writes into a result bag. Left out is what it says
/// of itself and of its machine.
class ReplayedMonitor {
 public:
  struct Model {
    std::string path;
    bool calibrated = false;
    std::int64_t window = 0;                           ///< length of a window [ns]
    std::size_t types = 0;                             ///< number of event types of the model
    std::vector<core::evidence::Coverage> coverage{};  ///< empty: not known
  };

  /// @param bag must outlive it
  /// @param types event types of the recording by id, those of the model first
  /// @param start of the recording [ns]
  ReplayedMonitor(ResultBag& bag, const Model& model, const std::vector<core::EventType>& types,
                  std::int64_t start);
  ReplayedMonitor(const ReplayedMonitor&) = delete;
  ReplayedMonitor& operator=(const ReplayedMonitor&) = delete;

  /// The detector has judged the next window.
  void onVerdict(const core::Verdict& verdict);
  /// The detector has taken in the next event.
  /// @param same_clock what Detector::add() returned
  void onEvent(const core::Event& event, bool same_clock);

 private:
  void writeDiagnostics();
  HeardTally::Moment moment() const { return {now_, now_ + steady_ahead_, 0}; }

  ResultBag& bag_;
  const Model model_;
  const core::Vocabulary vocabulary_;
  AlarmState alarm_;
  std::int64_t now_;               // time of the recording [ns]
  std::int64_t steady_ahead_ = 0;  // of that time [ns]: it goes on where the clock was set
  HeardTally heard_;
};

}  // namespace self_awareness::ros1
