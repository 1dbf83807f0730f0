#include <cmath>
#include <ctime>
#include <utility>

#include "clock_status.h"
#include "monitor.h"
#include "not_heard.h"
#include "nothing_heard.h"
#include "ros/now.h"
#include "ros/verdict/components.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/ros/ros_time.h"

namespace self_awareness {

ros1::HeardTally::Moment Monitor::momentNow() {
  timespec cpu{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
  return {rosNow(), steadyNow(), cpu.tv_sec * core::kNanosecondsPerSecond + cpu.tv_nsec};
}

void Monitor::onReport() {
  const Discovery::State discovered = live_->discovery().state();
  ros1::HeardTally::Moment moment = momentNow();
  moment.ros = live_->now();
  MonitorState state;
  state.communication.model = parameters_.model;
  state.communication.model_error = model_error_;
  if (session_) {
    state.communication.calibrated = session_->calibrated();
    state.communication.coverage = session_->coverage();
    state.communication.unheard = session_->unheard();
    state.communication.expected = session_->expected();
    state.communication.shares = session_->takeShares();
    for (const core::evidence::Coverage& each : session_->coverage()) {
      if (restarts_.count(each.component, moment.ros) > 0) {
        state.communication.restarts[each.component] = {
            restarts_.inWords(each.component, moment.ros),
            restarts_.count(each.component, moment.ros) >= Restarts::kMany &&
                mutes_.ofComponent(each.component).empty()};
      }
    }
    state.communication.optional = session_->optional();
    state.communication.strangers = session_->strangers();
    state.communication.disarmed = session_->disarmed();
    accepts_.tell(session_->types(), state.communication);
    state.communication.mode = mode_;
  }
  state.communication.take(announcer_.alarm(), heard_.report(moment, live_->events().dropped()),
                           moment.ros);
  const bool deaf =
      state.communication.heard.known_types + state.communication.heard.unknown_types == 0;
  const std::int64_t waited = moment.steady - started_at_;
  if (session_ && deaf && waited >= kNothingHeard &&
      !clockStands(live_->clock().standsStillFor())) {
    state.communication.nothing_heard =
        "nothing has been heard for " + ros1::number(std::floor(core::toSeconds(waited))) +
        " s: " + whyNothingIsHeard(live_->graph().get(), *session_->encoder());
  }
  state.subscriptions = discovered.subscriptions;
  state.connections = live_->events().connections();
  state.left_out_topics = discovered.left_out;
  state.full_of_unknown = session_ && session_->full();
  state.mode = session_ ? session_->mode(moment.ros) : "";
  state.ros_now = moment.ros;
  state.clock_stands_still_for = live_->clock().standsStillFor();
  state.longest_pause = core::toSeconds(std::exchange(longest_pause_, 0));
  state.master_answers = discovered.master_answers;
  state.taken_back = calls_.onRecord();
  state.mutes = mutes_.inWords();
  state.communication.muted = mutes_.ofWhatStands();
  state.clock_rivals = live_->clockRivals();
  if (session_) {
    state.unheard =
        withoutOptional(live_->discovery().unheard(), parameters_.optional, *session_->encoder());
    not_heard_.set(state.unheard, *session_->encoder());
    state.communication.not_heard = not_heard_.components();
  }
  state.keeper_error = keeper_.error().empty() ? incidents_.error() : keeper_.error();
  state.accept_error = accepts_.error();
  state.drift_error = drift_.error();
  for (const DriftKeeper::Told& each : drift_.told()) {
    if (mutes_.ofComponent(each.component).empty()) {
      state.drift.push_back(each.words);
    }
  }
  if (recorder_.enabled()) {
    state.recorder = recorder_.report();
  }
  if (kept_logs_.enabled()) {
    state.kept_logs = kept_logs_.report();
  }
  if (session_ && moment.steady - components_at_ >= core::kNanosecondsPerSecond) {
    components_at_ = moment.steady;
    self_awareness::Components components =
        ros1::toComponents(state.communication, live_->graph().get(), *session_->encoder());
    components.header.stamp = ros1::toRosTime(moment.ros);
    components.mutes = state.mutes;
    components_publisher_.publish(components);
  }
  diagnostics_.publish(std::move(state));
}

}  // namespace self_awareness
