#include "self_awareness/ros/model/model_merge.h"

#include <algorithm>
#include <array>
#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <string>

namespace self_awareness::ros1 {
namespace {

std::string seconds(std::int64_t nanoseconds) {
  std::ostringstream text;
  text << std::setprecision(12) << core::toSeconds(nanoseconds) << " s";
  return text.str();
}

std::int64_t horizon(const core::paper::Binning& binning) {
  return binning.horizon_bins * binning.bin_size;
}

// Throws std::invalid_argument unless the two are the same.
// @param none what a 0 means, in words
void requireSame(const std::string& what, std::int64_t one, std::int64_t other,
                 const std::string& none) {
  const auto text = [&](std::int64_t time) { return time == 0 ? none : seconds(time); };
  if (one != other) {
    throw std::invalid_argument("another " + what + ": " + text(other) + ", not " + text(one));
  }
}

void requireSameEncoding(const EncodingRules& one, const EncodingRules& other) {
  const auto require = [](const std::string& what, bool same) {
    if (!same) {
      throw std::invalid_argument("another encoding: " + what + " differs");
    }
  };
  require("source", one.source == other.source);
  require("rename", one.renames == other.renames);
  require("include_topics", one.include_topics == other.include_topics);
  require("exclude_topics", one.exclude_topics == other.exclude_topics);
  require("include_sources", one.include_sources == other.include_sources);
  require("exclude_sources", one.exclude_sources == other.exclude_sources);
  require("type_fields", one.type_fields == other.type_fields);
  require("the classes of type_fields", one.classes == other.classes);
  require("mode", one.mode == other.mode);
}

/// And what is watched.
void dropCalibrations(TrainedModel& model) {
  model.watched = {};
  model.left_out.clear();
  model.findings.clear();
  model.calibration.reset();
  model.paper_calibration.reset();
}

core::SourceGraph renamed(const core::SourceGraph& graph, const Encoder& encoder) {
  core::SourceGraph renamed;
  for (const auto& [publisher, topic, subscriber] : graph.edges()) {
    renamed.connect(encoder.sourceOf(publisher), encoder.scopeOf(topic),
                    encoder.sourceOf(subscriber));
  }
  for (const auto& [source, host] : graph.hosts()) {
    renamed.place(encoder.sourceOf(source), host);
  }
  for (const auto& [source, topic] : graph.unheard()) {
    renamed.addUnheard({encoder.sourceOf(source), encoder.scopeOf(topic)});
  }
  for (const auto& [subscription, recordings] : graph.lasting()) {
    renamed.addLasting(
        {encoder.sourceOf(subscription.first), encoder.scopeOf(subscription.second)}, recordings);
  }
  return renamed;
}

}  // namespace

void merge(TrainedModel& model, const TrainedModel& other) {
  for (const TrainedModel* each : {static_cast<const TrainedModel*>(&model), &other}) {
    if (!each->hasEvidence() && (each->isWatched() || !each->hasDelays())) {
      throw std::invalid_argument("loaded without its counts");
    }
  }
  requireSameEncoding(model.encoding, other.encoding);
  const core::paper::Binning& binning = model.statistics.binning();
  const core::paper::Binning& others = other.statistics.binning();
  requireSame("length of the windows", model.window, other.window, "0 s");
  requireSame("bin size", binning.bin_size, others.bin_size, "0 s");
  requireSame("horizon", horizon(binning), horizon(others), "none");
  if (model.hasEvidence() != other.hasEvidence() || model.hasDelays() != other.hasDelays()) {
    throw std::invalid_argument("trained for another detector: " + other.detectors() + ", not " +
                                model.detectors() + "; train both with the same --detector");
  }
  core::Vocabulary vocabulary = model.statistics.vocabulary();
  for (const core::EventType& type : other.statistics.vocabulary().types()) {
    vocabulary.intern(type);
  }
  checkEventTypes(model.encoding, vocabulary);

  model.statistics.merge(other.statistics);
  core::evidence::merge(model.evidence, model.onlyHalf(), other.evidence, other.onlyHalf());
  for (const auto& [publisher, topic, subscriber] : other.graph.edges()) {
    model.graph.connect(publisher, topic, subscriber);
  }
  for (const auto& [source, host] : other.graph.hosts()) {
    model.graph.place(source, host);
  }
  for (const core::SourceGraph::Publication& publication : other.graph.unheard()) {
    model.graph.addUnheard(publication);
  }
  for (const auto& [subscription, recordings] : other.graph.lasting()) {
    model.graph.addLasting(subscription, recordings);
  }
  model.recordings.insert(model.recordings.end(), other.recordings.begin(),
                          other.recordings.end());
  if (model.tuning != other.tuning) {
    model.tuning = {};
  }
  dropCalibrations(model);
  model.stamp = std::max(model.stamp, other.stamp);
  model.version.method = std::min(model.version.method, other.version.method);
}

void rename(TrainedModel& model, const std::vector<Rename>& rules) {
  EncodingRules these;
  these.renames = rules;
  const Encoder encoder(these, nullptr);
  const auto name = [&](const core::EventType& type) {
    return core::EventType{encoder.sourceOf(type.source), encoder.scopeOf(type.scope), type.type};
  };
  const std::array<core::Vocabulary, 3> renamed_types{
      model.vocabulary().renamed(name), model.evidence[0].vocabulary().renamed(name),
      model.evidence[1].vocabulary().renamed(name)};
  model.statistics.rename(renamed_types[0]);
  model.evidence[0].rename(renamed_types[1]);
  model.evidence[1].rename(renamed_types[2]);
  model.graph = renamed(model.graph, encoder);
  model.encoding.renames.insert(model.encoding.renames.end(), rules.begin(), rules.end());
  dropCalibrations(model);
}

}  // namespace self_awareness::ros1
