#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "ros/verdict/status_lists.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/verdict/detector.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/live/subscriptions.h"

namespace self_awareness {

/// Those that are not expected to be heard all the time are left out.
/// @param optional patterns of nodes or topics that may be absent
/// @param encoder gives nodes and topics the names that the patterns are of
std::vector<ros1::Unheard> withoutOptional(std::vector<ros1::Unheard> unheard,
                                           const std::vector<std::string>& optional,
                                           const ros1::Encoder& encoder);

/// Who is not heard, where, and why, in words.
std::vector<std::string> inWords(const std::vector<ros1::Unheard>& unheard);

/// Adds to the status of a node who it does not hear, though the master names them: a warning.
void tellUnheard(const std::vector<ros1::Unheard>& unheard, ros1::ListsAre lists,
                 diagnostic_updater::DiagnosticStatusWrapper& status);

/// Keeps apart who is silent and who the monitor cannot hear: where the network between them is
/// gone, or the publisher does not let the monitor in, nothing is known of who does not come.
///
/// A node that is dead is silent, as its machine says that nobody listens at its address.
class NotHeard {
 public:
  /// Takes over who is not heard now.
  /// @param encoder gives them the names that events have
  void set(const std::vector<ros1::Unheard>& unheard, const ros1::Encoder& encoder);
  /// Says so of suspects that do not come, or come late.
  void explain(std::vector<core::Suspect>& suspects, const core::Vocabulary& vocabulary) const;
  /// In words, by component (core::componentOf()).
  std::map<std::string, std::string> components() const;

 private:
  std::map<std::pair<std::string, std::string>, std::string> why_;  // by source and topic
};

}  // namespace self_awareness
