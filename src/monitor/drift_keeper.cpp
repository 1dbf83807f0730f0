#include "drift_keeper.h"

#include <ros/console.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <utility>

#include "diagnostics.h"
#include "ros/verdict/drift_file.h"
#include "session.h"
#include "stretch.h"

namespace self_awareness {
namespace {

using core::evidence::Drift;
using core::evidence::DriftSamples;

constexpr double kPause = 5;  // between two attempts to write the file [s]

std::size_t mostSamples(std::size_t components) {
  return components == 0 ? 0
                         : std::min(ros1::kMostDriftSamples, ros1::kMostDriftShares / components);
}

std::string inWords(const std::string& component, const Drift::Component& drift) {
  char text[96];
  std::snprintf(text, sizeof text, " %.0f %% -> %.0f %% of its limit, evidence %.2g",
                100 * drift.usual, 100 * drift.last, drift.evidence);
  return component + text;
}

}  // namespace

DriftKeeper::DriftKeeper(std::string run_id, std::int64_t robot_start)
    : run_id_(std::move(run_id)), robot_start_(robot_start), writer_(kPause) {}

void DriftKeeper::onStart(const Session& session, const std::string& path) {
  session_ = &session;
  setModel(path, {session.content(), session.components()});
}

void DriftKeeper::onVerdict(core::Verdict& verdict, ros1::Circumstances& /*circumstances*/) {
  if (!verdict.settling) {
    const std::int64_t begin = verdict.window->start;
    add(begin, begin + session_->window(), session_->sharesOfWindow());
  }
}

void DriftKeeper::onReport(MonitorState& state) {
  state.drift = told_;
  state.drift_error = error();
}

void DriftKeeper::setModel(const std::string& path, Judged judged) {
  endStretch();
  const std::string file = ros1::pathOfDrift(path);
  if (file == path_ && judged.model == judged_.model && judged.components == judged_.components) {
    return;  // what is not written yet is newer than the file
  }
  path_ = file;
  judged_ = std::move(judged);
  logged_.clear();
  samples_ = DriftSamples(judged_.components.size(), mostSamples(judged_.components.size()));
  read();
  tell();
}

void DriftKeeper::read() {
  if (judged_.components.empty()) {
    return;
  }
  try {
    const std::optional<self_awareness::KeptDrift> kept = ros1::readDrift(path_);
    if (kept && kept->model == judged_.model && kept->components == judged_.components) {
      restore(*kept);
    } else if (kept) {
      ROS_INFO("%s is of another model: the drift begins anew", path_.c_str());
    }
  } catch (const std::exception& error) {
    ROS_ERROR("%s; the drift begins anew", error.what());
  }
}

void DriftKeeper::restore(const self_awareness::KeptDrift& kept) {
  const auto width = static_cast<std::ptrdiff_t>(judged_.components.size());
  std::vector<std::vector<double>> samples;
  for (auto share = kept.shares.begin(); share != kept.shares.end(); share += width) {
    samples.emplace_back(share, share + width);
  }
  samples_.restore(samples, {kept.start, kept.day, kept.robot_start, kept.end});
  if (!run_id_.empty() && kept.run_id == run_id_) {
    robot_start_ = kept.robot_start;  // only the monitor was started again
  }
}

void DriftKeeper::add(std::int64_t begin, std::int64_t end, const std::vector<double>& shares) {
  if (shares.size() != judged_.components.size() || shares.empty()) {
    return;  // there are no limits
  }
  if (!stretch_) {
    stretch_.emplace();
    stretch_->begin = begin;
    stretch_->robot_start = robot_start_;
    stretch_->shares.resize(shares.size(), 0);
    normal_ = true;
  }
  stretch_->end = end;
  for (std::size_t number = 0; number < shares.size(); ++number) {
    stretch_->shares[number] = std::max(stretch_->shares[number], shares[number]);
  }
  if (end - stretch_->begin >= kLongestStretch) {
    endStretch();
  }
}

void DriftKeeper::endStretch() {
  const std::optional<DriftSamples::Stretch> stretch = std::exchange(stretch_, std::nullopt);
  if (!stretch || !normal_ || stretch->end - stretch->begin < kShortestStretch) {
    return;
  }
  if (samples_.add(*stretch)) {
    write();
    tell();
  }
}

void DriftKeeper::forget() {
  stretch_.reset();
  if (samples_.list().empty()) {
    return;
  }
  samples_ = DriftSamples(judged_.components.size(), mostSamples(judged_.components.size()));
  logged_.clear();
  write();
  tell();
}

void DriftKeeper::onRobotStart(std::int64_t at) {
  endStretch();
  robot_start_ = at;
  run_id_.clear();  // that of the new master is not known
}

void DriftKeeper::finish() {
  endStretch();
  writer_.finish();
}

void DriftKeeper::write() {
  self_awareness::KeptDrift kept;
  kept.model = judged_.model;
  kept.components = judged_.components;
  kept.run_id = run_id_;
  kept.robot_start = samples_.last().robot_start;
  kept.start = samples_.last().start;
  kept.day = samples_.last().day;
  kept.end = samples_.last().end;
  for (const std::vector<double>& shares : samples_.list()) {
    kept.shares.insert(kept.shares.end(), shares.begin(), shares.end());
  }
  const std::size_t bytes = kept.shares.size() * sizeof(double);
  writer_.add({path_, bytes, [kept = std::move(kept)](const std::string& path) {
                 ros1::writeDrift(kept, path);
               }});
}

void DriftKeeper::tell() {
  const Drift drift = samples_.drift();
  std::vector<std::pair<double, Told>> told;
  for (std::size_t number = 0; number < judged_.components.size(); ++number) {
    const Drift::Component component = drift.component(number);
    if (component.evidence >= drift.needed()) {
      const std::string& name = judged_.components[number];
      told.emplace_back(component.evidence, Told{name, inWords(name, component)});
    }
  }
  std::stable_sort(told.begin(), told.end(),
                   [](const auto& one, const auto& other) { return one.first > other.first; });
  told_.clear();
  for (auto& [evidence, each] : told) {
    if (logged_.insert(each.component).second) {
      ROS_WARN("drift: %s (docs/learn_more.md)", each.words.c_str());
    }
    told_.push_back(std::move(each));
  }
}

}  // namespace self_awareness
