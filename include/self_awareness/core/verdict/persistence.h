#pragma once

#include <cstdint>
#include <deque>

namespace self_awareness::core {

/// Decides when abnormal windows are an alarm (docs/method.md, section 4.2): k abnormal ones among
/// the last n raise it, and it clears after a hold time without any.
class Persistence {
 public:
  struct Parameters {
    int alarm_windows = 3;                ///< k, 1 to n
    int alarm_of = 5;                     ///< n
    std::int64_t hold_time = 2000000000;  ///< [ns], 0 or more
  };

  /// @throw std::invalid_argument if a parameter is out of range
  explicit Persistence(const Parameters& parameters);

  /// Takes in the next window.
  /// @param end of the window [ns]
  /// @param certain raises the alarm at once
  /// @return raised()
  bool add(bool abnormal, std::int64_t end, bool certain = false);
  /// Leaves out the next window: it says nothing, and the hold time stands still.
  /// @param length of the window [ns]
  /// @return raised()
  bool leaveOut(std::int64_t length);
  /// Raises the alarm, whatever the windows say.
  /// @param end of the window that counts as abnormal [ns]
  void raise(std::int64_t end);
  /// Whether the alarm stands.
  bool raised() const { return raised_; }
  /// Forgets all windows and the alarm.
  void clear();

 private:
  Parameters parameters_;
  std::deque<bool> recent_;
  std::int64_t last_abnormal_ = 0;  // end of the window [ns], while raised
  bool raised_ = false;
};

}  // namespace self_awareness::core
