#include "monitor.h"

#include <ros/console.h>
#include <ros/this_node.h>

#include <utility>

#include "node/processor_watch.h"
#include "ros/verdict/kept_files.h"
#include "self_awareness/Incidents.h"
#include "self_awareness/SelfAwareness.h"
#include "self_awareness/ros/model/model_file.h"
#include "self_awareness/ros/ros_time.h"

namespace self_awareness {

Monitor::Monitor(ros::NodeHandle node_handle, const ros::NodeHandle& private_node_handle,
                 const std::string& name)
    : private_node_handle_(private_node_handle),
      parameters_(MonitorParameters::load(private_node_handle)),
      alarm_({[this](const self_awareness::SelfAwareness& status) {
                status_publisher_.publish(status);
              },
              [this](const self_awareness::SelfAwareness& alarm) {
                alarm_publisher_.publish(alarm);
                all(&Part::onAlarm, alarm_);
              },
              [this] { live_->report(); }}),
      reports_(*this, node_handle, private_node_handle_, name),
      operators_(calls_, *this, [this] { return reload(); }),
      recorder_(parameters_.recorder, [this] { return source(); }),
      kept_logs_(
          parameters_.kept_logs, [this] { return source(); }, ros1::wallNow()),
      not_heard_(*this),
      blocked_(*this, [this](std::vector<std::string> nodes) { live_->ask(std::move(nodes)); }),
      restarts_(*this),
      keeper_(folderOf(parameters_.recorder), parameters_.run_id),
      incidents_(folderOf(parameters_.recorder),
                 [this](const self_awareness::Incidents& incidents) {
                   incidents_publisher_.publish(incidents);
                 }),
      accepts_(calls_, {[this] { return acceptable(); },
                        [this](const std::string& caller) { onAccepted(caller); }}),
      mutes_(calls_, *this),
      parts_({&reports_, &operators_, &recorder_, &kept_logs_, &not_heard_, &blocked_, &quotes_,
              &restarts_, &keeper_, &incidents_, &accepts_, &mutes_}) {
  node_handle.setCallbackQueue(&queue_);
  private_node_handle_.setCallbackQueue(&queue_);
  status_publisher_ = private_node_handle_.advertise<self_awareness::SelfAwareness>("status", 100);
  alarm_publisher_ =
      private_node_handle_.advertise<self_awareness::SelfAwareness>("alarm", 10, true);
  incidents_publisher_ =
      private_node_handle_.advertise<self_awareness::Incidents>("incidents", 10, true);
  live_ = std::make_unique<LiveSource>(queue_, node_handle, parameters_.live, advertise(), *this);
  try {
    load(parameters_.model);
  } catch (const ros1::ModelFileError& error) {
    // Not fatal: the operator sees it in the diagnostics, and ~reload tries again.
    reports_.onNoModel(error.what());
    ROS_ERROR("%s", error.what());
  }
  resume();
  live_->start();
}

Monitor::~Monitor() {
  finish();
}

void Monitor::finish() {
  live_->stop();  // first: what it serves uses the parts
  all(&Part::finish);
}

std::vector<std::string> Monitor::advertise() {
  std::vector<std::string> names;
  for (Part* part : parts_) {
    for (ros::ServiceServer& service : part->advertise(private_node_handle_)) {
      names.push_back(service.getService());
      services_.push_back(std::move(service));
    }
  }
  return names;
}

void Monitor::load(const std::string& path) {
  std::unique_ptr<Session> session = Session::load(
      path, parameters_, [this](const core::Verdict& verdict) { onVerdict(verdict); });
  all(&Part::onCut, Cut::kOtherModel);
  parameters_.model = path;
  session_ = std::move(session);
  alarm_.forgetWindow();
  all(&Part::onStart, *session_, path);
  session_->accept(accepts_.accepted());
  live_->setWanted(session_->wanted(ros::this_node::getName(), parameters_.live.poll_interval));
  ROS_INFO("model %s: %zu event types, %s", path.c_str(), session_->types().size(),
           session_->calibrated() ? "calibrated" : "not calibrated, it will never alarm");
}

std::string Monitor::reload() {
  try {
    // The question would wait for a master that hangs, and all events with it.
    load(live_->discovery().state().master_answers
             ? MonitorParameters::loadModel(private_node_handle_, parameters_.model)
             : parameters_.model);
  } catch (const std::exception& error) {
    if (!session_) {
      reports_.onNoModel(error.what());
    }
    std::string why = std::string(error.what()) + (session_ ? "; the old model stays" : "");
    ROS_ERROR("%s", why.c_str());
    return why;
  }
  return "";
}

std::optional<Acceptable> Monitor::acceptable() const {
  if (!session_ || parameters_.method != MonitorParameters::Method::kEvidence) {
    return std::nullopt;
  }
  return Acceptable{alarm_.standing(),      incidents_.incidents(),
                    session_->vocabulary(), session_->detector().unknown(),
                    *session_->encoder(),   live_->now()};
}

void Monitor::onAccepted(const std::string& caller) {
  session_->accept(accepts_.accepted());
  const std::optional<core::Alarm>& stands = alarm_.standing();
  if (stands && accepts_.covers(*stands, session_->vocabulary())) {
    calls_.record("accept", caller, ros1::wallNow());
    session_->detector().clearAlarm();
    standDown("accepted, by " + caller);
  }
  report();
}

void Monitor::resume() {
  const std::optional<self_awareness::StandingAlarm> standing = keeper_.read();
  const bool stands = standing && session_ && session_->calibrated();
  incidents_.restore(stands ? std::optional(standing->alarm.alarm) : std::nullopt);
  if (stands) {
    const auto suspects = ros1::fromMessages(standing->alarm.suspects, session_->vocabulary());
    session_->detector().resume(suspects);
    ROS_WARN("an alarm stood when this monitor ended: it stands until its cause is over");
    alarm_.resume(*standing, suspects);
  }
}

void Monitor::onEvent(const core::Event& event) {
  if (session_->isFirstOfRestarted(event.id)) {
    restarts_.onFirst(event);
  }
  if (!session_->detector().add(event)) {
    restart();
    session_->detector().add(event);
  }
  all(&Part::onEvent, event, session_->vocabulary());
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

void Monitor::onPause(std::int64_t pause) {
  if (session_) {
    reports_.onPause(pause);
    notNormal("this program stood still");
  }
}

void Monitor::onWaiting(const core::Waiting& waiting) {
  if (session_) {
    session_->detector().hear(waiting);
    all(&Part::onWaiting, waiting);
  }
}

void Monitor::onDropped(const ros1::Publication& publication) {
  if (session_) {
    session_->detector().onMissed(session_->typesOf(publication), live_->now());
    notNormal("messages were dropped");
  }
}

void Monitor::onGraph(const ros1::Graph& graph) {
  session_->addEdges(graph, ros::this_node::getName());
  all(&Part::onGraph, graph);
}

void Monitor::onSenders(const core::Senders& senders) {
  if (session_) {
    session_->setSenders(senders);
  }
}

void Monitor::onMasterRestart(std::int64_t /*now*/) {
  kept_logs_.onRobotStart(ros1::wallNow());
}

void Monitor::onTick(std::int64_t now) {
  live_->deliver();
  if (session_) {
    session_->detector().advance(now - kGrace);
  }
  all(&Part::onTick, Moment{now, ros1::steadyNow(), now - kGrace});
}

void Monitor::restart() {
  ROS_WARN("ROS time was set: delays and windows start afresh");
  session_->detector().restart();
  all(&Part::onCut, Cut::kClockSet);
  standDown(ros1::kClockWasSet);
}

void Monitor::onVerdict(const core::Verdict& verdict) {
  core::Verdict said = verdict;
  ros1::Circumstances circumstances;
  circumstances.load = verdict.busy ? loadInWords() : "";
  all(&Part::onVerdict, said, circumstances);
  if (verdict.alarm || verdict.suspicion) {
    notNormal(verdict.alarm ? "an alarm" : "a suspicion");
  }
  alarm_.add(said, session_->vocabulary(), session_->window(), circumstances);
}

}  // namespace self_awareness
