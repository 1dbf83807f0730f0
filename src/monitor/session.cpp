#include "session.h"

#include <utility>

#include "self_awareness/core/evidence/judge.h"
#include "self_awareness/core/paper/judge.h"
#include "self_awareness/ros/stable_name.h"

namespace self_awareness {

Session::Session(ros1::TrainedModel trained, const MonitorParameters& parameters,
                 core::Detector::Handler handler)
    : trained_(std::move(trained)),
      calibrated_(parameters.method == MonitorParameters::Method::kPaper
                      ? trained_.paper_calibration.has_value()
                      : trained_.calibration.has_value()),
      unheard_(trained_.unheard()),
      graph_(std::make_shared<core::SourceGraph>(trained_.graph)),
      vocabulary_(std::make_shared<core::Vocabulary>(trained_.vocabulary())),
      encoder_(std::make_shared<ros1::Encoder>(
          trained_.encoding, [this](const core::EventType& type) { return intern(type); })),
      detector_(makeJudge(parameters), trained_.window, parameters.detector, std::move(handler)) {
  if (parameters.method == MonitorParameters::Method::kEvidence) {
    coverage_ = trained_.coverage();
  }
  // The judge has made of them what it needs.
  trained_.dropCounts();
  trained_.watched = {};
}

std::unique_ptr<core::Judge> Session::makeJudge(const MonitorParameters& parameters) const {
  if (parameters.method == MonitorParameters::Method::kPaper) {
    trained_.requireDelays();
    return core::paper::makeJudge(std::make_shared<core::paper::Model>(trained_.statistics),
                                  trained_.threshold(), parameters.detector.silence_is_abnormal);
  }
  trained_.requireWatched();
  return core::evidence::makeJudge(std::make_shared<core::evidence::Model>(trained_.watched),
                                   trained_.limits(), trained_.window, graph_, vocabulary_);
}

core::EventId Session::intern(const core::EventType& type) {
  return ros1::internUpTo(trained_.vocabulary().size() + kMostUnknownTypes, type, *vocabulary_);
}

std::set<std::string> Session::topics() const {
  std::set<std::string> topics;
  for (const core::EventType& type : types()) {
    topics.insert(type.scope);
  }
  return topics;
}

std::vector<core::EventId> Session::typesOf(const ros1::Publication& publication) const {
  const std::string source =
      encoder_->tellsSources() ? ros1::stableName(publication.node) : std::string();
  std::vector<core::EventId> ids;
  for (core::EventId id = 0; id < types().size(); ++id) {
    if (types()[id].source == source && types()[id].scope == publication.topic) {
      ids.push_back(id);
    }
  }
  return ids;
}

ros1::OwnOutput Session::ownOutput(const std::string& node) const {
  ros1::OwnOutput::Known known;
  for (const core::EventType& type : types()) {
    known.insert({type.source, type.scope});
  }
  return {node, std::move(known)};
}

void Session::addEdges(const ros1::Graph& graph, const std::string& node) {
  ros1::addEdges(graph, node, *graph_);
}

}  // namespace self_awareness
