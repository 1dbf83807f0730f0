#pragma once

#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "node/discovery.h"
#include "part.h"
#include "self_awareness/core/stream/event.h"

namespace self_awareness {

/// Who keeps a silent node waiting, in words; empty: nobody, or it does not answer itself.
/// @param publishers nodes of the name that is silent
/// @param subscribers of all that they publish
std::string whoBlocks(const std::set<std::string>& publishers,
                      const std::set<std::string>& subscribers, const Discovery::Answers& answers);

/// Tells who is silent since a subscriber of it hangs: a rospy node without a queue_size waits in
/// publish() until all have read. Once in an alarm, its node and the subscribers are asked.
class BlockedNode : public Part {
 public:
  /// Has these nodes asked (Discovery::ask()).
  using Ask = std::function<void(std::vector<std::string> nodes)>;

  BlockedNode(Host& host, Ask ask) : host_(host), ask_(std::move(ask)) {}

  void onVerdict(core::Verdict& verdict, ros1::Circumstances& circumstances) override;
  /// Of an alarm of before the start, nobody is asked.
  void onAlarm(const ros1::AlarmState& alarm) override;

 private:
  enum class Step { kNone, kAsked, kTold };

  /// Has who sends an event type asked, and all who listen to it.
  void ask(const core::EventType& type);

  Host& host_;
  const Ask ask_;
  Step step_ = Step::kNone;
  std::set<std::string> publishers_;
  std::set<std::string> subscribers_;
};

}  // namespace self_awareness
