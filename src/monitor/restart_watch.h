#pragma once

#include "host.h"
#include "part.h"
#include "restarts.h"

namespace self_awareness {

/// Excuses a node that was started again until it is as usual, and says so; who is started again
/// and again is a near miss, and no more excused.
class RestartWatch : public Part {
 public:
  explicit RestartWatch(Host& host);

  /// The first event of a type has come since its node was started again, and is judged next.
  void onFirst(const core::Event& event);
  void onGraph(const ros1::Graph& graph) override;
  void onTick(const Moment& now) override;
  void onCut(Cut why) override;
  void onReport(MonitorState& state) override;

 private:
  void onRestarted(const std::string& source, core::Alarm near_miss);

  Host& host_;
  Restarts restarts_;
};

}  // namespace self_awareness
