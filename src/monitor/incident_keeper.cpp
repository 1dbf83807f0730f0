#include "incident_keeper.h"

#include <ros/console.h>

#include <algorithm>
#include <exception>
#include <utility>
#include <vector>

#include "diagnostics.h"
#include "ros/verdict/kept_files.h"
#include "self_awareness/ros/ros_time.h"
#include "session.h"

namespace self_awareness {
namespace {

/// Nobody watches an incident any more. @return it was open
bool leaveAlone(self_awareness::Incident& incident) {
  const bool was_open = incident.over == 0U;
  if (was_open) {
    incident.over = incident.unknown = 1U;
  }
  return was_open;
}

}  // namespace

IncidentKeeper::IncidentKeeper(RecorderFolder folder,
                               std::function<void(const self_awareness::Incidents&)> publish)
    : folder_(std::move(folder)),
      path_(folder_.pathOfIncidents()),
      publish_(std::move(publish)),
      folded_(kRepeatsWithin, ros1::kMostIncidents) {}

void IncidentKeeper::restore(std::optional<std::uint64_t> standing) {
  try {
    incidents_ = ros1::readIncidents(path_).value_or(self_awareness::Incidents());
  } catch (const std::exception& error) {
    ROS_ERROR("%s; the incidents before this start are not known", error.what());
  }
  std::vector<core::Incident> known;
  for (self_awareness::Incident& each : incidents_.incidents) {
    if (each.last != standing) {
      written_ = !leaveAlone(each) && written_;
    } else if (each.unknown != 0U) {
      each.over = each.unknown = 0U;
    }
    sources_[each.id] = {each.recording, each.model};
    known.push_back(ros1::fromMessage(each));
  }
  folded_.restore(std::move(known));
  if (!written_) {
    write();
  }
  publish_(incidents_);
}

void IncidentKeeper::onStart(const Session& session, const std::string& path) {
  session_ = &session;
  model_ = path;
}

void IncidentKeeper::onAlarm(const ros1::AlarmState& alarm) {
  for (const std::optional<core::Alarm>* each : {&alarm.ended(), &alarm.standing()}) {
    if (*each) {
      add(**each, session_->graph(), alarm.recording(), model_);
    }
  }
  publish_(incidents_);
}

void IncidentKeeper::addNearMiss(const core::Alarm& alarm) {
  add(alarm, session_->graph(), "", model_);
  publish_(incidents_);
}

void IncidentKeeper::onReport(MonitorState& state) {
  if (state.keeper_error.empty()) {
    state.keeper_error = error();
  }
}

void IncidentKeeper::add(const core::Alarm& alarm, const core::SourceGraph& graph,
                         const std::string& recording, const std::string& model) {
  folded_.add(core::occurrenceOf(alarm), graph);
  const bool is_alarm = alarm.level == core::Alarm::Level::kAlarm;
  incidents_.header.stamp = ros1::toRosTime(alarm.end);
  incidents_.incidents.clear();
  sources_.try_emplace(alarm.id, Source{is_alarm ? recording : "", model});
  std::map<std::uint64_t, Source> sources{{alarm.id, sources_[alarm.id]}};
  for (const core::Incident& incident : folded_.list(graph)) {
    self_awareness::Incident& message =
        incidents_.incidents.emplace_back(ros1::toMessage(incident));
    const Source& source = sources[incident.id] = sources_[incident.id];
    message.recording = source.recording;
    message.model = source.model;
  }
  sources_ = std::move(sources);
  written_ = false;
  if (is_alarm) {
    write();
  }
}

void IncidentKeeper::onTick(const Moment& now) {
  now_ = now;
  if (!written_ && now.steady - written_at_ >= kNearMissesEvery) {
    written_at_ = now.steady;
    write();
  }
}

void IncidentKeeper::finish() {
  for (self_awareness::Incident& each : incidents_.incidents) {
    if (leaveAlone(each)) {
      each.ended = std::max(each.ended, ros1::toRosTime(now_.ros));
      written_ = false;
    }
  }
  if (!written_) {
    write();
  }
  writer_.finish();
}

void IncidentKeeper::write() {
  written_ = true;
  writer_.add({path_, 0, [folder = folder_, incidents = incidents_](const std::string& path) {
                 folder.create();
                 ros1::writeIncidents(incidents, path);
               }});
}

}  // namespace self_awareness
