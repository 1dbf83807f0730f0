#include "self_awareness/ros/model_file.h"

#include <rosbag/bag.h>
#include <rosbag/exceptions.h>
#include <rosbag/view.h>
#include <unistd.h>

#include <algorithm>
#include <boost/filesystem/operations.hpp>
#include <cmath>
#include <cstdio>

#include "self_awareness/ros/evidence_message.h"

namespace self_awareness::ros1 {
namespace {

constexpr char kTopic[] = "/model";

void check(bool holds, const std::string& otherwise) {
  if (!holds) {
    throw std::invalid_argument(otherwise);
  }
}

self_awareness::Encoding toMessage(const EncodingRules& rules) {
  self_awareness::Encoding message;
  message.source = rules.source == EncodingRules::Source::kNone
                       ? self_awareness::Encoding::SOURCE_NONE
                       : self_awareness::Encoding::SOURCE_CALLERID;
  message.include_topics = rules.include_topics;
  message.exclude_topics = rules.exclude_topics;
  message.include_sources = rules.include_sources;
  message.exclude_sources = rules.exclude_sources;
  for (const auto& [datatype, field] : rules.type_fields) {
    self_awareness::TypeField type_field;
    type_field.datatype = datatype;
    type_field.field = field;
    message.type_fields.push_back(type_field);
  }
  return message;
}

EncodingRules fromMessage(const self_awareness::Encoding& message) {
  EncodingRules rules;
  const bool none = message.source == self_awareness::Encoding::SOURCE_NONE;
  check(none || message.source == self_awareness::Encoding::SOURCE_CALLERID,
        "its encoding has the unknown source '" + message.source + "'");
  rules.source = none ? EncodingRules::Source::kNone : EncodingRules::Source::kCallerId;
  rules.include_topics = message.include_topics;
  rules.exclude_topics = message.exclude_topics;
  rules.include_sources = message.include_sources;
  rules.exclude_sources = message.exclude_sources;
  for (const self_awareness::TypeField& type_field : message.type_fields) {
    rules.type_fields[type_field.datatype] = type_field.field;
  }
  rules.validate();
  return rules;
}

void appendHistograms(const core::DelayStatistics& statistics, self_awareness::Model& message) {
  const std::size_t n = statistics.vocabulary().size();
  message.offsets.push_back(0);
  for (core::EventId to = 0; to < n; ++to) {
    for (core::EventId from = 0; from < n; ++from) {
      for (const core::Histogram::Entry& entry : statistics.pair(from, to).entries()) {
        message.bins.push_back(entry.bin);
        message.counts.push_back(entry.count);
      }
      message.offsets.push_back(message.bins.size());
    }
  }
}

core::DelayStatistics statisticsOf(const self_awareness::Model& message) {
  core::DelayStatistics statistics(core::Binning{message.bin_size, message.horizon_bins});
  for (const self_awareness::EventType& type : message.event_types) {
    const std::size_t before = statistics.vocabulary().size();
    const core::EventId id = statistics.intern({type.source, type.scope, type.type});
    check(id == before, "an event type occurs twice");
    statistics.countEvent(id, type.count);
  }
  const std::size_t n = message.event_types.size();
  check(message.offsets.size() == n * n + 1 && message.offsets.front() == 0 &&
            message.offsets.back() == message.bins.size() &&
            message.bins.size() == message.counts.size() &&
            std::is_sorted(message.offsets.begin(), message.offsets.end()),
        "its histograms do not fit its event types");
  for (std::size_t histogram = 0; histogram < n * n; ++histogram) {
    const auto from = static_cast<core::EventId>(histogram % n);
    const auto to = static_cast<core::EventId>(histogram / n);
    for (std::size_t i = message.offsets[histogram]; i < message.offsets[histogram + 1]; ++i) {
      check(message.counts[i] > 0 && message.bins[i] >= 0, "a histogram has an impossible bin");
      statistics.pair(from, to).add(message.bins[i], message.counts[i]);
    }
  }
  check(statistics.events() > 0, "it was trained on no event");
  return statistics;
}

self_awareness::Model::ConstPtr readMessage(const std::string& path) {
  if (!boost::filesystem::is_regular_file(path)) {
    throw ModelFileError(path +
                         ": no such file; train a model first "
                         "(rosrun self_awareness train)");
  }
  try {
    rosbag::Bag bag(path, rosbag::bagmode::Read);
    rosbag::View view(bag);
    for (const rosbag::MessageInstance& message : view) {
      if (message.getDataType() != ros::message_traits::datatype<self_awareness::Model>()) {
        break;
      }
      if (message.getMD5Sum() != ros::message_traits::md5sum<self_awareness::Model>()) {
        throw ModelFileError(path + ": written by another version of self_awareness (md5 " +
                             message.getMD5Sum() + ", this one reads " +
                             ros::message_traits::md5sum<self_awareness::Model>() +
                             "); train the model again");
      }
      return message.instantiate<self_awareness::Model>();
    }
  } catch (const rosbag::BagException& error) {
    throw ModelFileError(path + ": not a model file, or a damaged one (" + error.what() + ")");
  } catch (const ros::serialization::StreamOverrunException& error) {
    throw ModelFileError(path + ": a damaged model file (" + error.what() + ")");
  }
  throw ModelFileError(path +
                       ": a bag, but it holds no model; train one from it "
                       "(rosrun self_awareness train)");
}

bool limitsFit(const TrainedModel& model) {
  const core::EvidenceLimits limits = limitsOf(*model.evidence_calibration);
  const core::EvidenceModel evidence(model.evidence[0], model.evidence[1]);
  return limits.tracks.size() == evidence.tracks().size() && std::isfinite(limits.linker) &&
         limits.linker > 0;
}

}  // namespace

std::optional<double> TrainedModel::threshold() const {
  return calibration ? std::optional<double>(calibration->threshold) : std::nullopt;
}

std::optional<core::EvidenceLimits> TrainedModel::limits() const {
  return evidence_calibration ? std::optional(limitsOf(*evidence_calibration)) : std::nullopt;
}

self_awareness::Model toMessage(const TrainedModel& model) {
  self_awareness::Model message;
  message.stamp = model.stamp;
  message.encoding = toMessage(model.encoding);
  message.window.fromNSec(model.window);
  message.bin_size = model.statistics.binning().bin_size;
  message.horizon_bins = model.statistics.binning().horizon_bins;
  for (core::EventId id = 0; id < model.statistics.vocabulary().size(); ++id) {
    const core::EventType& type = model.statistics.vocabulary().at(id);
    self_awareness::EventType event_type;
    event_type.source = type.source;
    event_type.scope = type.scope;
    event_type.type = type.type;
    event_type.count = model.statistics.eventCount(id);
    message.event_types.push_back(event_type);
  }
  appendHistograms(model.statistics, message);
  for (const core::EvidenceStatistics& half : model.evidence) {
    message.evidence.push_back(toMessage(half, model.statistics.vocabulary()));
  }
  for (const auto& [from, followers] : model.graph.edges()) {
    for (const std::string& to : followers) {
      self_awareness::GraphEdge edge;
      edge.from_source = from;
      edge.to_source = to;
      message.graph.push_back(edge);
    }
  }
  message.recordings = model.recordings;
  if (model.calibration) {
    message.calibration.push_back(*model.calibration);
  }
  if (model.evidence_calibration) {
    message.evidence_calibration.push_back(*model.evidence_calibration);
  }
  return message;
}

TrainedModel fromMessage(const self_awareness::Model& message) {
  TrainedModel model;
  model.stamp = message.stamp;
  model.encoding = fromMessage(message.encoding);
  model.window = message.window.toNSec();
  check(model.window > 0, "its windows have no length");
  model.statistics = statisticsOf(message);
  check(message.evidence.size() == model.evidence.size(), "its evidence has not two halves");
  std::transform(message.evidence.begin(), message.evidence.end(), model.evidence.begin(),
                 [&](const self_awareness::Evidence& half) {
                   return fromMessage(half, model.statistics.vocabulary());
                 });
  for (const self_awareness::GraphEdge& edge : message.graph) {
    model.graph.connect(edge.from_source, edge.to_source);
  }
  model.recordings = message.recordings;
  check(message.calibration.size() <= 1, "it has more than one calibration");
  if (!message.calibration.empty()) {
    model.calibration = message.calibration.front();
    check(std::isfinite(model.calibration->threshold), "its threshold is not a finite number");
  }
  check(message.evidence_calibration.size() <= 1, "it has more than one calibration");
  if (!message.evidence_calibration.empty()) {
    model.evidence_calibration = message.evidence_calibration.front();
    check(limitsFit(model), "its limits are not those of its evidence; calibrate it again");
  }
  return model;
}

void saveModel(const TrainedModel& model, const std::string& path) {
  const std::string temporary = path + ".part" + std::to_string(::getpid());
  try {
    rosbag::Bag bag(temporary, rosbag::bagmode::Write);
    bag.setCompression(rosbag::compression::LZ4);
    // A bag cannot hold a message of the time 0.
    bag.write(kTopic, std::max(model.stamp, ros::TIME_MIN), toMessage(model));
    bag.close();
    boost::filesystem::rename(temporary, path);
  } catch (const std::exception& error) {
    std::remove(temporary.c_str());
    throw ModelFileError(path + ": cannot be written (" + error.what() + ")");
  }
}

TrainedModel loadModel(const std::string& path) {
  const self_awareness::Model::ConstPtr message = readMessage(path);
  try {
    return fromMessage(*message);
  } catch (const std::invalid_argument& error) {
    throw ModelFileError(path + ": a damaged model file: " + error.what());
  }
}

}  // namespace self_awareness::ros1
