#include "diagnostics.h"

#include "node/node_status.h"
#include "session.h"

namespace self_awareness {

using diagnostic_msgs::DiagnosticStatus;
using ros1::number;

namespace {

using Status = diagnostic_updater::DiagnosticStatusWrapper;

void tellKeptLogs(const KeptLogs::Report& report, Status& status) {
  if (!report.files.error.empty()) {
    status.mergeSummary(DiagnosticStatus::WARN,
                        "logs of normal operation cannot be kept: " + report.files.error);
  }
  status.add("logs kept to learn from", report.files.written);
  status.add("logs left out as not normal", report.left_out);
  if (!report.why.empty()) {
    status.add("why the last one was", report.why);
  }
}

void tellRecorder(const FlightRecorder::Report& report, Status& status) {
  if (!report.files.error.empty()) {
    status.mergeSummary(DiagnosticStatus::WARN,
                        "the flight recorder cannot write: " + report.files.error);
  }
  status.add("recorded [s]", number(report.seconds));
  status.add("memory of the recorder [MB]", number(static_cast<double>(report.bytes) * 1e-6));
  status.add("files of the recorder", report.files.written);
  status.add("files given up", report.files.given_up);
  status.add("last file", report.files.last_written);
}

}  // namespace

std::string allLists(const MonitorState& state) {
  std::string lists = ros1::listed(state.mutes) + '\n' + ros1::listed(inWords(state.unheard));
  for (const auto& [key, list] : ros1::listsOf(state.communication)) {
    lists += '\n' + ros1::listed(list);
  }
  return lists;
}

void tellMonitor(const MonitorState& state, Status& status) {
  const ros1::HeardReport& heard = state.communication.heard;
  status.summary(DiagnosticStatus::OK, "listening");
  const auto warnIf = [&](bool holds, const std::string& words) {
    if (holds) {
      status.mergeSummary(DiagnosticStatus::WARN, words);
    }
  };
  warnIf(!state.master_answers, "the master does not answer");
  warnIf(heard.newly_dropped > 0, "overloaded: " + std::to_string(heard.newly_dropped) +
                                      " messages were dropped; who sent them is judged later");
  warnIf(state.longest_pause > 0, "overloaded: this program stood still for " +
                                      number(state.longest_pause) + " s; all are judged later");
  tellClock(state.clock_stands_still_for, state.ros_now, status);
  tellRivals(state.clock_rivals, status);
  warnIf(state.full_of_unknown,
         "more than " + std::to_string(Session::kMostUnknownTypes) +
             " event types that the model does not know: further ones are not told apart");
  warnIf(state.left_out_topics > 0,
         std::to_string(state.left_out_topics) + " topics are left out: there are too many");
  warnIf(!state.keeper_error.empty(),
         "what stands is not kept for another start: " + state.keeper_error);
  warnIf(!state.accept_error.empty(), "what is accepted is not kept: " + state.accept_error);
  tellUnheard(state.unheard, state.communication.lists, status);
  status.add("events a second", number(heard.rate));
  status.add("dropped messages", heard.dropped);
  status.add("subscriptions", state.subscriptions);
  status.add("event types that the model does not know", heard.unknown_types);
  status.add("publishers heard", state.connections);
  status.add("share of a core spent", number(heard.cpu_share));
  if (!state.mode.empty()) {
    status.add("mode", state.mode);
  }
  if (!state.taken_back.empty()) {
    status.add("alarm taken back", state.taken_back);
  }
  ros1::tellNumbered("mute", state.mutes, state.communication.lists, status);
  status.add("times the clock was set", heard.clock_steps);
  if (state.recorder) {
    tellRecorder(*state.recorder, status);
  }
  if (state.kept_logs) {
    tellKeptLogs(*state.kept_logs, status);
  }
}

}  // namespace self_awareness
