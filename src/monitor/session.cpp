#include "session.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "ros/content_digest.h"
#include "ros/text.h"
#include "ros/verdict/verdict_message.h"
#include "self_awareness/core/paper/judge.h"
#include "self_awareness/core/stream/mode.h"
#include "self_awareness/ros/file_version.h"

namespace self_awareness {
namespace {

constexpr std::size_t kMostOfText = 60;  // of a message, in a line of the diagnostics [bytes]
constexpr int kTicksPerWindow = 4;
// A node of this package has logged and read its parameters before the master knows what it
// publishes; so long that may take, besides the time until the master is asked [s].
constexpr double kToBeKnown = 4;

/// What ~optional accepts: that who has one of the names is absent.
/// @throw std::invalid_argument if there are too many
core::Acceptances absencesOf(const std::vector<std::string>& names) {
  core::Acceptances absences;
  for (const std::string& name : names) {
    if (!absences.add({name, "", core::Kind::kNeverCame}) ||
        !absences.add({"", name, core::Kind::kNeverCame})) {
      throw std::invalid_argument("~optional has too many names; name several by a *");
    }
  }
  return absences;
}

}  // namespace

std::unique_ptr<Session> Session::load(const std::string& path,
                                       const MonitorParameters& parameters,
                                       core::Detector::Handler handler) {
  if (path.empty()) {
    throw ros1::ModelFileError(parameters.recorder.name +
                               "/model is not set; give it the path of a model file");
  }
  ros1::TrainedModel trained = ros1::loadModel(
      path, parameters.method == MonitorParameters::Method::kPaper ? ros1::ModelCounts::kDelays
                                                                   : ros1::ModelCounts::kWatched);
  try {
    return std::make_unique<Session>(std::move(trained), parameters, std::move(handler));
  } catch (const std::invalid_argument& error) {
    throw ros1::ModelFileError(path + ": " + error.what());
  }
}

Session::Session(ros1::TrainedModel trained, const MonitorParameters& parameters,
                 core::Detector::Handler handler)
    : trained_(std::move(trained)),
      calibrated_(parameters.method == MonitorParameters::Method::kPaper
                      ? trained_.paper_calibration.has_value()
                      : trained_.calibration.has_value()),
      absences_(absencesOf(parameters.optional)),
      unheard_(trained_.unheard()),
      subscriptions_(trained_.expectedSubscriptions()),
      graph_(std::make_shared<core::SourceGraph>(trained_.graph)),
      vocabulary_(std::make_shared<core::Vocabulary>(trained_.vocabulary())),
      encoder_(std::make_shared<ros1::Encoder>(
          trained_.encoding, [this](const core::EventType& type) { return intern(type); })),
      detector_(makeJudge(parameters), trained_.window, parameters.detector, std::move(handler)) {
  accept({});
  if (parameters.method == MonitorParameters::Method::kEvidence) {
    expectRates();
  }
  // The judge has made of them what it needs.
  trained_.dropCounts();
  trained_.watched = {};
}

std::unique_ptr<core::Judge> Session::makeJudge(const MonitorParameters& parameters) {
  if (parameters.method == MonitorParameters::Method::kPaper) {
    trained_.requireDelays();
    return core::paper::makeJudge(std::make_shared<core::paper::Model>(trained_.statistics),
                                  trained_.threshold(), parameters.detector.silence_is_abnormal,
                                  vocabulary_);
  }
  trained_.requireWatched();
  model_ = std::make_shared<const core::evidence::Model>(trained_.watched);
  return core::evidence::makeJudge(
      model_, trained_.limits(), trained_.window, graph_, vocabulary_,
      [this](const core::Window& /*window*/, const core::evidence::Shares& shares) {
        onShares(shares);
      });
}

void Session::accept(const core::Acceptances& accepted) {
  accepted_ = accepted;
  accepted_.add(absences_);
  detector_.accept(accepted_);
  optional_.clear();
  std::vector<bool> may_be_silent;
  for (const core::EventType& type : types()) {
    const std::string& component = core::componentOf(type.source, type.scope);
    may_be_silent.push_back(accepted_.covers(component, type.scope, core::Kind::kSilent));
    if (accepted_.mayBeAbsent(component, type.scope)) {
      optional_.insert(component);
    }
  }
  if (!model_ || !trained_.calibration) {
    return;
  }
  coverage_ = core::evidence::coverageOf(*model_, trained_.calibration->limits,
                                         trained_.calibration->relations, trained_.window,
                                         !trained_.graph.empty(), may_be_silent);
}

void Session::onShares(const core::evidence::Shares& shares) {
  shares_.resize(model_->components().size(), 0);
  const auto raise = [&](core::EventId id, double share) {
    double& largest = shares_[model_->componentIndex(id)];
    largest = std::max(largest, share);
  };
  for (std::size_t track = 0; track < shares.tracks.size(); ++track) {
    if (shares.tracks[track] > 0) {
      raise(model_->tracks()[track].to, shares.tracks[track]);
    }
  }
  for (const auto& [id, share] : shares.never_heard) {
    raise(id, share);
  }
}

std::uint64_t Session::content() const {
  ros1::ContentDigest digest;
  const auto add = [&](const void* data, std::size_t size) {
    digest.add(static_cast<const std::uint8_t*>(data), size);
  };
  add(&ros1::kMethod, sizeof ros1::kMethod);
  for (const core::EventType& type : types()) {
    for (const std::string* text : {&type.source, &type.scope, &type.type}) {
      add(text->c_str(), text->size() + 1);
    }
  }
  if (trained_.paper_calibration) {
    add(&trained_.paper_calibration->threshold, sizeof trained_.paper_calibration->threshold);
  }
  if (trained_.calibration) {
    const std::vector<double>& limits = trained_.calibration->limits.tracks;
    add(limits.data(), limits.size() * sizeof(double));
  }
  return digest.value();
}

std::map<std::string, double> Session::takeShares() {
  std::map<std::string, double> shares;
  for (std::size_t i = 0; i < shares_.size(); ++i) {
    shares[model_->components()[i]] = shares_[i];
  }
  shares_.clear();
  return shares;
}

void Session::expectRates() {
  for (core::EventId id = 0; id < types().size(); ++id) {
    double seconds = 0;
    std::uint64_t gaps = 0;
    for (const core::evidence::Statistics& half : trained_.watched.halves) {
      if (id < half.size()) {
        seconds += core::toSeconds(half.type(id).gap_sum);
        gaps += half.type(id).gaps;
      }
    }
    const core::EventType& type = types()[id];
    if (seconds > 0 && !core::tellsMode(type)) {
      expected_[core::componentOf(type.source, type.scope)][type.scope] +=
          static_cast<double>(gaps) / seconds;
    }
  }
}

core::EventId Session::intern(const core::EventType& type) {
  return ros1::internUpTo(trained_.vocabulary().size() + kMostUnknownTypes, type, *vocabulary_);
}

void Session::onRestarted(const std::string& source) {
  for (core::EventId id = 0; id < types().size(); ++id) {
    if (types()[id].source == source) {
      restarted_.insert(id);
    }
  }
}

std::string Session::sourceAndTopic(core::EventId id) const {
  const core::EventType& type = vocabulary_->at(id);
  return ros1::withSource(type.source, type.scope);
}

void Session::tell(ros1::CommunicationState& state) const {
  state.calibrated = calibrated_;
  state.coverage = coverage_;
  state.unheard = unheard_;
  state.expected = expected_;
  state.optional = optional_;
  state.watched_less = watchedLess();
  for (const auto& [id, events] : detector_.unknown()) {
    const core::EventType& type = vocabulary_->at(id);
    state.strangers.push_back({type.source, type.scope, events});
  }
}

std::vector<std::string> Session::watchedLess() const {
  std::vector<std::string> words;
  for (const core::WatchedLess& each : detector_.watchedLess()) {
    char limit[40];
    std::snprintf(limit, sizeof limit, ": silent for more than %.1f s", each.limit);
    words.push_back(sourceAndTopic(each.id) +
                    (std::isinf(each.limit) ? " after " + sourceAndTopic(each.after) : limit));
  }
  return words;
}

std::string Session::mode(std::int64_t now) const {
  if (!trained_.encoding.mode || !model_) {
    return "";
  }
  const std::string topic =
      " (" + ros1::shortened(trained_.encoding.mode->topic, kMostOfText) + ")";
  const std::optional<core::LastingMode> mode = detector_.mode(now);
  if (!mode) {
    return "not known" + topic;
  }
  return ros1::shortened(core::modeOf(vocabulary_->at(mode->id)), kMostOfText) + topic + ", for " +
         std::to_string(mode->lasted / core::kNanosecondsPerSecond) + " s" +
         (model_->knows(mode->id) ? "" : ", not seen in training");
}

LiveSource::Wanted Session::wanted(const std::string& node, double poll_interval) const {
  LiveSource::Wanted wanted;
  wanted.encoder = encoder_;
  ros1::OwnOutput::Known known;
  for (const core::EventType& type : types()) {
    wanted.model_topics.insert(type.scope);
    known.insert({type.source, type.scope});
  }
  wanted.own_output = {node, std::move(known), encoder_};
  wanted.window = window();
  wanted.hold = std::llround((poll_interval + kToBeKnown) * 1e9);
  wanted.tick = ros::WallDuration(core::toSeconds(window()) / kTicksPerWindow);
  return wanted;
}

std::vector<core::EventId> Session::typesOf(const ros1::Publication& publication) const {
  const std::string source =
      encoder_->tellsSources() ? encoder_->sourceOf(publication.node) : std::string();
  const std::string scope = encoder_->scopeOf(publication.topic);
  std::vector<core::EventId> ids;
  for (core::EventId id = 0; id < types().size(); ++id) {
    if (types()[id].source == source && types()[id].scope == scope) {
      ids.push_back(id);
    }
  }
  return ids;
}

void Session::setSenders(const core::Senders& senders) {
  for (const core::EventType& type : senders.played) {
    intern(type);  // suspects have ids
  }
  detector_.setSenders(senders);
}

void Session::addEdges(const ros1::Graph& graph, const std::string& node) {
  ros1::addEdges(graph, node, *encoder_, *graph_);
  detector_.setMissing(ros1::missingIn(graph, *encoder_, subscriptions_));
}

}  // namespace self_awareness
