#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

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
std::string withoutNumbers(const std::string& text);

}  // namespace self_awareness::ros1
