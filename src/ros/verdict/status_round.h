#pragma once

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace self_awareness::ros1 {

/// Whether a status tells long lists, or only how long they are: /diagnostics is heard by
/// everybody, also over a radio link.
enum class ListsAre { kTold, kCounted };

/// The items of a list as one text of at most some 300 bytes, with how many more there are.
std::string listed(const std::vector<std::string>& list);

/// Adds a list as one value; none if it is empty. One of several items and more than 100 bytes
/// that is counted reads "37, listed every 20 s".
void tellList(const std::string& key, const std::vector<std::string>& list, ListsAre lists,
              diagnostic_updater::DiagnosticStatusWrapper& status);

/// Adds a value for each item, "KEY 1", "KEY 2", and how many further ones there are ("further
/// KEY"): as many as listed() tells; of one that is counted, as many as 100 bytes hold, and one at
/// least.
void tellNumbered(const std::string& key, const std::vector<std::string>& list, ListsAre lists,
                  diagnostic_updater::DiagnosticStatusWrapper& status);

/// Says when lists are to be told: when they have changed, and every 20 s.
class ListRound {
 public:
  /// @param lists all of them, as they would be told; that numbers in them change is no change
  /// @param elapsed since the last call [s]
  ListsAre next(const std::string& lists, double elapsed);

 private:
  std::string told_;
  double since_ = 0;  // they were told [s]
};

/// A text whose numbers are left out: "silent for 2.31 s" and "silent for 14 s" say the same.
std::string withoutNumbers(std::string text);

/// Chooses which statuses of components go out with a report: what has changed at once, what is
/// not OK every 5 s (two of them a report: they may be many), all else one after the other, as
/// many as a number of bytes allows, but everybody within 50 s: the aggregator takes for stale
/// what was not said for 60 s (config/diagnostic_analyzers.yaml). /diagnostics is heard by
/// everybody, also over a radio link.
class StatusRound {
 public:
  /// @param bytes_per_second that everything together may take
  explicit StatusRound(std::size_t bytes_per_second)
      : bytes_per_second_(static_cast<double>(bytes_per_second)) {}

  /// @param all statuses of components; names are unique
  /// @param others bytes of what goes out besides
  /// @param elapsed since the last report [s]
  /// @return those of them that go out now
  std::vector<diagnostic_msgs::DiagnosticStatus> next(
      const std::vector<diagnostic_msgs::DiagnosticStatus>& all, std::size_t others,
      double elapsed);

 private:
  struct Said {
    int level = 0;
    double since = 0;   // [s]
    std::string words;  // of the message, without numbers: they change all the time
  };

  double bytes_per_second_;
  double left_ = 0;                   // bytes that may be sent; below 0: what changed took more
  double due_ = 0;                    // statuses whose turn it is, whatever they take
  std::map<std::string, Said> said_;  // by name, as it was sent last
  std::string last_;                  // of the round: who is next comes after it
};

/// Bytes that a status takes in its message.
std::size_t bytesOf(const diagnostic_msgs::DiagnosticStatus& status);

}  // namespace self_awareness::ros1
