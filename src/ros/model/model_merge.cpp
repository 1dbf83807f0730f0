#include "self_awareness/ros/model/model_merge.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

namespace self_awareness::ros1 {
namespace {

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
  requireSameEncoding(model.encoding, other.encoding);
  core::Vocabulary vocabulary = model.vocabulary();
  for (const core::EventType& type : other.vocabulary().types()) {
    vocabulary.intern(type);
  }
  checkEventTypes(model.encoding, vocabulary);
  model.add(other);
  model.left_out.clear();
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
  model.dropWatched();
  model.left_out.clear();
}

}  // namespace self_awareness::ros1
