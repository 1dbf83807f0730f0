#include "monitor.h"

#include <ros/console.h>
#include <ros/param.h>
#include <ros/this_node.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "load.h"
#include "ros/now.h"
#include "ros/text.h"
#include "ros/verdict/standing_alarm.h"
#include "self_awareness/Components.h"
#include "self_awareness/Incidents.h"
#include "self_awareness/SelfAwareness.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/ros/ros_time.h"

namespace self_awareness {
namespace {

constexpr int kTicksPerWindow = 4;
// A node of this package has logged and read its parameters before the master knows what it
// publishes; so long that may take, besides the time until the master is asked [s].
constexpr double kToBeKnown = 4;

std::string runId() {
  std::string run_id;
  ros::param::get("/run_id", run_id);
  return run_id;
}

}  // namespace

Monitor::Monitor(ros::NodeHandle node_handle, const ros::NodeHandle& private_node_handle,
                 const std::string& name)
    : private_node_handle_(private_node_handle),
      parameters_(MonitorParameters::load(private_node_handle)),
      diagnostics_(node_handle, name, parameters_.hardware_id, parameters_.source_diagnostics,
                   parameters_.diagnostic_bytes),
      mutes_(calls_, [this] { onMutes(); }),
      accepts_(calls_,
               {[this] { return acceptable(); },
                [this](const std::string& caller, bool undo) { onAccepted(caller, undo); }}),
      announcer_({[this](const self_awareness::SelfAwareness& status) {
                    status_publisher_.publish(status);
                  },
                  [this](const self_awareness::SelfAwareness& alarm) { publishAlarm(alarm); },
                  [this] { live_->report(); }}),
      heard_(momentNow()),
      recorder_(parameters_.recorder,
                [this] {
                  return FlightRecorder::Source{session_->encoding(), live_->graph()};
                }),
      kept_logs_(
          parameters_.kept_logs,
          [this] {
            return FlightRecorder::Source{session_->encoding(), live_->graph()};
          },
          wallNow()),
      drift_(runId(), wallNow()),
      keeper_(folderOf(parameters_.recorder), runId()),
      incidents_(folderOf(parameters_.recorder)),
      restarts_(parameters_.detector.settle_time) {
  node_handle.setCallbackQueue(&queue_);
  private_node_handle_.setCallbackQueue(&queue_);
  status_publisher_ = private_node_handle_.advertise<self_awareness::SelfAwareness>("status", 100);
  alarm_publisher_ =
      private_node_handle_.advertise<self_awareness::SelfAwareness>("alarm", 10, true);
  incidents_publisher_ =
      private_node_handle_.advertise<self_awareness::Incidents>("incidents", 10, true);
  components_publisher_ =
      private_node_handle_.advertise<self_awareness::Components>("components", 1, true);
  services_ = {private_node_handle_.advertiseService("reset", &Monitor::onReset, this),
               private_node_handle_.advertiseService("clear", &Monitor::onClear, this),
               private_node_handle_.advertiseService("dump", &Monitor::onDump, this),
               private_node_handle_.advertiseService("reload", &Monitor::onReload, this)};
  for (ros::ServiceServer& service : mutes_.advertise(private_node_handle_)) {
    services_.push_back(std::move(service));
  }
  services_.push_back(accepts_.advertise(private_node_handle_));
  std::vector<std::string> service_names;
  for (const ros::ServiceServer& service : services_) {
    service_names.push_back(service.getService());
  }
  live_ = std::make_unique<LiveSource>(queue_, node_handle, parameters_.live,
                                       std::move(service_names), *this);
  try {
    load(parameters_.model);
  } catch (const ros1::ModelFileError& error) {
    // Not fatal: the operator sees it in the diagnostics, and ~reload tries again.
    model_error_ = error.what();
    ROS_ERROR("%s", error.what());
  }
  resume();
  live_->start();
}

Monitor::~Monitor() {
  finish();
}

void Monitor::finish() {
  live_->stop();  // first: what it serves uses the recorder
  recorder_.finish(announcer_.alarm().message().level == self_awareness::SelfAwareness::ERROR);
  kept_logs_.finish();
  drift_.finish();
  keeper_.finish();
  incidents_.finish(live_->now());
  accepts_.finish();
}

void Monitor::load(const std::string& path) {
  std::unique_ptr<Session> session = makeSession(path);
  parameters_.model = path;
  startSession(std::move(session));
}

std::unique_ptr<Session> Monitor::makeSession(const std::string& path) {
  if (path.empty()) {
    throw ros1::ModelFileError(private_node_handle_.resolveName("model") +
                               " is not set; give it the path of a model file");
  }
  ros1::TrainedModel trained = ros1::loadModel(
      path, parameters_.method == MonitorParameters::Method::kPaper ? ros1::ModelCounts::kDelays
                                                                    : ros1::ModelCounts::kWatched);
  try {
    return std::make_unique<Session>(std::move(trained), parameters_,
                                     [this](const core::Verdict& verdict) { onVerdict(verdict); });
  } catch (const std::invalid_argument& error) {
    throw ros1::ModelFileError(path + ": " + error.what());
  }
}

std::string Monitor::modelPath() const {
  // The question would wait for a master that hangs, and all events with it.
  return live_->discovery().state().master_answers
             ? MonitorParameters::loadModel(private_node_handle_, parameters_.model)
             : parameters_.model;
}

void Monitor::startSession(std::unique_ptr<Session> session) {
  recorder_.restart();  // the events to come are those of another model
  kept_logs_.endStretch();
  session_ = std::move(session);
  kept_logs_.setModel(parameters_.model, session_->calibrated());
  keeper_.setModel(session_->content());
  drift_.setModel(parameters_.model, {session_->content(), session_->components()});
  quotes_.clear();
  model_error_.clear();
  mode_.clear();
  announcer_.forgetWindow();
  heard_.setTypes(session_->types());
  accepts_.read(parameters_.model);
  session_->accept(accepts_.accepted());
  LiveSource::Wanted wanted;
  wanted.encoder = session_->encoder();
  wanted.model_topics = session_->topics();
  wanted.own_output = session_->ownOutput(ros::this_node::getName());
  wanted.window = session_->window();
  wanted.hold = std::llround((parameters_.live.poll_interval + kToBeKnown) * 1e9);
  wanted.tick = ros::WallDuration(core::toSeconds(wanted.window) / kTicksPerWindow);
  live_->setWanted(std::move(wanted));
  started_at_ = steadyNow();
  ROS_INFO("model %s: %zu event types of %zu components, %s", parameters_.model.c_str(),
           session_->types().size(), heard_.components(),
           session_->calibrated() ? "calibrated" : "not calibrated, it will never alarm");
}

void Monitor::onEvent(const core::Event& event) {
  if (!session_->vocabulary().tellsMode(event.id)) {  // else its message is another event
    heard_.add(event);
  }
  if (session_->isFirstOfRestarted(event.id)) {
    onFirstOfRestarted(event);
  }
  if (!session_->detector().add(event)) {
    restart();
    session_->detector().add(event);
  }
  recorder_.add(event, session_->vocabulary());
  kept_logs_.add(event, session_->vocabulary());
}

void Monitor::onContent(core::EventId id, const ros1::Content& content) {
  if (id >= session_->types().size()) {
    quotes_.add(id, session_->vocabulary().at(id), content);
  }
}

void Monitor::onClockSet(std::int64_t /*now*/) {
  if (session_ && session_->detector().started()) {  // else there is nothing to forget
    restart();
  }
}

void Monitor::onPause(std::int64_t now, std::int64_t pause) {
  if (session_) {
    longest_pause_ = std::max(longest_pause_, pause);
    notNormal("this program stood still");
    session_->detector().onPause(now);
  }
}

void Monitor::onWaiting(const core::Waiting& waiting) {
  if (session_) {
    session_->detector().hear(waiting);
    recorder_.add(waiting);
    kept_logs_.add(waiting);
  }
}

void Monitor::onSenders(const core::Senders& senders) {
  if (session_) {
    session_->setSenders(senders);
  }
}

void Monitor::onDropped(const ros1::Publication& publication) {
  if (session_) {
    session_->detector().onMissed(session_->typesOf(publication), live_->now());
    notNormal("messages were dropped");
  }
}

void Monitor::onTick(std::int64_t now) {
  live_->deliver();
  if (session_) {
    session_->detector().advance(now - kGrace);
  }
  recorder_.advance(now - kGrace, steadyNow());
  if (mutes_.mutesAll()) {
    notNormal("maintenance");
  }
  kept_logs_.advance(now - kGrace);
  followRestarts(now);
  incidents_.advance(steadyNow());
  mutes_.advance(steadyNow());
}

void Monitor::restart() {
  ROS_WARN("ROS time was set: delays and windows start afresh");
  session_->detector().restart();
  heard_.onClockStep();
  restarts_.onClockSet();
  recorder_.restart();
  kept_logs_.endStretch();
  drift_.endStretch();
  standDown(ros1::kClockWasSet);
}

void Monitor::resume() {
  const std::optional<self_awareness::StandingAlarm> standing = keeper_.read();
  const bool stands = standing && session_ && session_->calibrated();
  incidents_.restore(stands ? std::optional(standing->alarm.alarm) : std::nullopt);
  incidents_publisher_.publish(incidents_.incidents());
  if (!stands) {
    return;
  }
  session_->detector().resume(
      ros1::fromMessages(standing->alarm.suspects, session_->vocabulary()));
  alarm_file_ = standing->recording;
  recorder_.onAlarmResumed(alarm_file_);
  ROS_WARN("an alarm stood when this monitor ended: it stands until its cause is over");
  announcer_.resume(standing->alarm, ros1::fromRosTime(standing->since));
}

void Monitor::onVerdict(const core::Verdict& verdict) {
  const bool stood = announcer_.alarm().message().level == self_awareness::SelfAwareness::ERROR;
  mode_ = verdict.mode;
  if (!verdict.settling) {
    const std::int64_t begin = verdict.window->start;
    drift_.add(begin, begin + session_->window(), session_->sharesOfWindow());
  }
  if (verdict.alarm || verdict.suspicion) {
    notNormal(verdict.alarm ? "an alarm" : "a suspicion");
  }
  if (verdict.alarm && !stood) {
    alarm_file_ = recorder_.onAlarm(steadyNow());
  }
  if (!verdict.alarm && stood) {
    recorder_.onAlarmOver();
  }
  core::Verdict said = verdict;
  if (!said.suspects.empty()) {
    not_heard_.set(live_->discovery().unheard(), *session_->encoder());
    not_heard_.explain(said.suspects, session_->vocabulary());
    not_heard_.explain(said.new_suspects, session_->vocabulary());
    quotes_.explain(said.suspects);
    quotes_.explain(said.new_suspects);
  }
  announcer_.add(said, session_->vocabulary(), session_->window(),
                 {verdict.busy ? loadInWords() : "", alarm_file_});
}

void Monitor::notNormal(const std::string& why) {
  kept_logs_.leaveOut(why);
  drift_.leaveOut();
}

void Monitor::standDown(const std::string& message) {
  recorder_.onAlarmOver();
  announcer_.standDown(message, live_->now());
}

void Monitor::publishAlarm(const self_awareness::SelfAwareness& alarm) {
  mutes_.onStanding(announcer_.alarm().standing(), *session_);
  mutes_.log(alarm);
  alarm_publisher_.publish(alarm);
  keeper_.keep(alarm, announcer_.alarm().since(), alarm_file_);
  publishIncidents();
}

void Monitor::publishIncidents() {
  const ros1::AlarmState& state = announcer_.alarm();
  for (const std::optional<core::Alarm>* alarm : {&state.ended(), &state.standing()}) {
    if (*alarm) {
      incidents_.add(**alarm, session_->graph(), alarm_file_, parameters_.model);
    }
  }
  incidents_publisher_.publish(incidents_.incidents());
}

void Monitor::onMutes() {
  if (session_) {
    if (mutes_.onStanding(announcer_.alarm().standing(), *session_)) {
      mutes_.log(announcer_.alarm().message());
    }
    live_->report();
  }
}

std::optional<Acceptable> Monitor::acceptable() const {
  if (!session_ || parameters_.method != MonitorParameters::Method::kEvidence) {
    return std::nullopt;
  }
  return Acceptable{announcer_.alarm().standing(),  incidents_.incidents(), session_->vocabulary(),
                    session_->detector().unknown(), *session_->encoder(),   live_->now()};
}

void Monitor::onAccepted(const std::string& caller, bool undo) {
  session_->accept(accepts_.accepted());
  if (undo) {
    drift_.forget();  // what is judged again would look like a drift
  }
  const std::optional<core::Alarm>& stands = announcer_.alarm().standing();
  if (stands && accepts_.covers(*stands, session_->vocabulary())) {
    calls_.record("accept", caller, wallNow());
    session_->detector().clearAlarm();
    standDown("accepted, by " + caller);
  }
  live_->report();
}

void Monitor::standDownFor(const Call& call, const std::string& service,
                           const std::string& message) {
  if (announcer_.alarm().stands()) {
    calls_.record(service, call.getCallerName(), wallNow());
  }
  standDown(message);
}

bool Monitor::onReset(Call& call) {
  if (calls_.mayServe("reset", call, steadyNow())) {
    call.getResponse().success = session_ != nullptr;
    call.getResponse().message =
        session_ ? "delays, windows and the alarm start afresh" : model_error_;
    if (session_) {
      session_->detector().restart();
      standDownFor(call, "reset", "settling: reset");
    }
  }
  return true;
}

bool Monitor::onClear(Call& call) {
  if (calls_.mayServe("clear", call, steadyNow())) {
    const bool stood = announcer_.alarm().stands();
    call.getResponse().success = 1U;
    call.getResponse().message = stood ? "the alarm is cleared" : "there is no alarm";
    if (stood) {
      session_->detector().clearAlarm();
      standDownFor(call, "clear", "cleared by hand, by " + ros1::printable(call.getCallerName()));
    }
  }
  return true;
}

bool Monitor::onDump(std_srvs::Trigger::Request& /*request*/,
                     std_srvs::Trigger::Response& response) {
  const std::optional<std::string> path = recorder_.dump();
  const FlightRecorder::Report report = recorder_.report();
  response.success = path && report.files.error.empty();
  if (!recorder_.enabled()) {
    response.message = "there is no flight recorder: ~recorder/duration is 0";
  } else if (!path) {
    response.message = "nothing was heard yet";
  } else if (!report.files.error.empty()) {
    response.message = report.files.error + "; it is tried again";
  } else {
    response.message = "the last " + ros1::number(report.seconds) + " s go to " + *path;
  }
  return true;
}

bool Monitor::onReload(Call& call) {
  if (!calls_.mayServe("reload", call, steadyNow())) {
    return true;
  }
  std_srvs::Trigger::Response& response = call.getResponse();
  try {
    load(modelPath());
  } catch (const std::exception& error) {
    if (!session_) {
      model_error_ = error.what();
    }
    response.success = 0U;
    response.message = std::string(error.what()) + (session_ ? "; the old model stays" : "");
    ROS_ERROR("%s", response.message.c_str());
    return true;
  }
  standDownFor(call, "reload", "settling: model loaded");
  // What stood before the start, when there was no model, may have been over for long.
  keeper_.keep(announcer_.alarm().message(), announcer_.alarm().since(), alarm_file_);
  response.success = 1U;
  response.message = "loaded " + parameters_.model;
  return true;
}

}  // namespace self_awareness
