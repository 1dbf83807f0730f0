#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "part.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/verdict/acceptance.h"
#include "self_awareness/core/verdict/detector.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/live/subscriptions.h"

namespace self_awareness {

/// Those that are not expected to be heard all the time are left out.
/// @param accepted among it, whose absence
/// @param encoder gives nodes and topics the names that are accepted
std::vector<ros1::Unheard> withoutOptional(std::vector<ros1::Unheard> unheard,
                                           const core::Acceptances& accepted,
                                           const ros1::Encoder& encoder);

/// Keeps apart who is silent and who the monitor cannot hear: where the network between them is
/// gone, or the publisher does not let the monitor in, nothing is known of who does not come.
///
/// A node that is dead is silent, as its machine says that nobody listens at its address.
class NotHeard : public Part {
 public:
  explicit NotHeard(Host& host) : host_(host) {}

  /// Says so of suspects that do not come, or come late.
  void onVerdict(core::Verdict& verdict, ros1::Circumstances& circumstances) override;
  void onReport(MonitorState& state) override;

 private:
  /// Takes over who is not heard now.
  /// @param encoder gives them the names that events have
  void set(const std::vector<ros1::Unheard>& unheard, const ros1::Encoder& encoder);
  void explain(std::vector<core::Suspect>& suspects, const core::Vocabulary& vocabulary) const;
  /// In words, by component (core::componentOf()).
  std::map<std::string, std::string> components() const;

  Host& host_;
  std::map<std::pair<std::string, std::string>, std::string> why_;  // by source and topic
};

}  // namespace self_awareness
