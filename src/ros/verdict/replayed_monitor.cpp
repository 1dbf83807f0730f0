#include "replayed_monitor.h"

namespace self_awareness::ros1 {
namespace {

constexpr double kHeartbeat = 1;  // [s], as ~diagnostic_period is by default

}  // namespace

ReplayedMonitor::ReplayedMonitor(ResultBag& bag, const Model& model,
                                 const std::vector<core::EventType>& types, std::int64_t start)
    : bag_(bag),
      model_(model),
      vocabulary_(types),
      announcer_(
          {[this](const self_awareness::SelfAwareness& status) { bag_.writeStatus(now_, status); },
           [this](const self_awareness::SelfAwareness& alarm) { bag_.writeAlarm(now_, alarm); },
           [this] { writeDiagnostics(); }}),
      now_(start),
      heard_(moment()) {
  heard_.setTypes({types.begin(), types.begin() + static_cast<std::ptrdiff_t>(model.types)});
}

void ReplayedMonitor::onVerdict(const core::Verdict& verdict) {
  now_ = verdict.window->start + model_.window;
  announcer_.add(verdict, vocabulary_, model_.window);
  if (heard_.sinceReport(moment().steady) >= kHeartbeat) {
    writeDiagnostics();
  }
}

void ReplayedMonitor::onEvent(const core::Event& event, bool same_clock) {
  if (!same_clock) {
    steady_ahead_ += now_ - event.stamp;
    now_ = event.stamp;
    heard_.onClockStep();
    announcer_.standDown(kClockWasSet, now_);
  }
  if (vocabulary_.isMessage(event.id)) {
    heard_.add(event);
  }
}

void ReplayedMonitor::writeDiagnostics() {
  CommunicationState state;
  state.model = model_.path;
  state.calibrated = model_.calibrated;
  state.coverage = model_.coverage;
  state.take(announcer_.alarm(), heard_.report(moment(), 0), now_);
  bag_.writeDiagnostics(now_, toDiagnostics(state, ResultBag::kNode, now_));
}

}  // namespace self_awareness::ros1
