#pragma once

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "../../in_folder.h"
#include "../../problem.h"
#include "core/paper/delay_trainer.h"
#include "ros/model/model_parts.h"
#include "self_awareness/ModelPart.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/evidence/count/trainer.h"
#include "self_awareness/core/evidence/limits/limits.h"
#include "self_awareness/ros/model/model_file.h"

namespace self_awareness::ros1 {

/// Model files in a folder of their own.
class ModelFileTest : public InFolder {
 protected:
  static std::string modelError(const std::string& file) {
    return problemOf<ModelFileError>([&] { loadModel(file); });
  }

  static TrainedModel someModel() {
    TrainedModel model;
    model.encoding = EncodingRules::defaults();
    model.statistics = core::paper::DelayStatistics(core::paper::Binning{5000000, 20});
    const core::EventId a = model.statistics.intern({"/a", "/x", "T"});
    const core::EventId b = model.statistics.intern({"/b", "/y", "T[action=1]"});
    core::paper::DelayTrainer trainer(model.statistics);
    for (core::evidence::Statistics& half : model.evidence) {
      half.intern(model.statistics.vocabulary().at(a));
      half.intern(model.statistics.vocabulary().at(b));
      core::evidence::Trainer evidence(half, model.window);
      for (int i = 0; i < 150; ++i) {
        const core::Event event{i * 37000000LL, i % 3 == 0 ? b : a};
        trainer.add(event);
        evidence.add(event);
      }
      trainer.startRecording();
      evidence.finish();
    }
    model.watch();
    model.stamp = 1700000000 * core::kNanosecondsPerSecond;
    core::RecordingInfo recording;
    recording.bag = "normal.bag";
    recording.events = 300;
    recording.fingerprint = 0xfedcba9876543210;
    model.recordings = {recording};
    return model;
  }

  // Limits for everything that the model watches; the first track is not judged.
  static TrainedModel calibratedModel() {
    TrainedModel model = someModel();
    model.calibration = core::Calibration();
    model.calibration->method = core::Calibration::kHeldOut;
    model.calibration->limits.tracks.assign(model.watched.tracks.size(), 2.5);
    model.calibration->limits.tracks.at(0) = std::numeric_limits<double>::quiet_NaN();
    model.calibration->budget = 0.25;
    model.calibration->windows = 1234;
    model.calibration->recordings = model.recordings;
    model.calibration->false_alarms_per_hour = 0.125;
    core::evidence::Relation relation;
    relation.spread = 0.25;
    relation.starts = 2;
    relation.starts_needed = 3;
    model.calibration->relations.assign(model.watched.tracks.size(), relation);
    model.calibration->relations.at(1).watched = true;
    model.calibration->relations.at(1).reaches = true;
    model.calibration->relations.at(1).irregular = true;
    model.findings = someFindings(model);
    return model;
  }

  // What two recordings of the training showed, one of them in two parts.
  static core::evidence::LimitFinder::Findings someFindings(const TrainedModel& model) {
    using core::evidence::LimitFinder;
    using core::evidence::Said;
    LimitFinder::Findings findings(2);
    for (std::size_t k = 0; k < findings.size(); ++k) {
      LimitFinder::Recording& recording = findings[k];
      recording.start = 1000000000LL * static_cast<std::int64_t>(k + 1);
      recording.end = recording.start + 123456789;
      recording.trained_on = true;
      for (std::size_t part = 0; part <= k; ++part) {
        LimitFinder::Recording::Part& added = recording.parts.emplace_back();
        added.windows = 100 * k + part;
        recording.windows += added.windows;
        for (std::size_t track = 0; track < model.watched.tracks.size(); ++track) {
          added.evidence.push_back(static_cast<float>(track) + 0.5F * static_cast<float>(part));
        }
        for (std::size_t id = 0; id < model.vocabulary().size(); ++id) {
          added.longest_gaps.push_back(static_cast<std::int64_t>(1000 * id + part));
        }
      }
      for (std::size_t track = 0; track < model.watched.tracks.size(); ++track) {
        recording.said.push_back(static_cast<Said>((track + k) % 3));
      }
    }
    return findings;
  }

  // Error on loading a model file whose messages a test has changed.
  std::string damagedFile(
      const std::function<void(rosbag::Bag&, const rosbag::MessageInstance&)>& write) {
    saveModel(calibratedModel(), path("whole"));
    const rosbag::Bag whole(path("whole"), rosbag::bagmode::Read);
    rosbag::Bag damaged(path("damaged"), rosbag::bagmode::Write);
    for (const rosbag::MessageInstance& message : rosbag::View(whole)) {
      if (message.getTopic() != "/digest") {  // else it says that the file is damaged, and no more
        write(damaged, message);
      }
    }
    damaged.close();
    return modelError(path("damaged"));
  }
  // The same, of the first part on a topic.
  template <typename Change>
  std::string damagedPart(const std::string& topic, Change change) {
    bool done = false;
    return damagedFile([&](rosbag::Bag& damaged, const rosbag::MessageInstance& message) {
      if (message.getTopic() == topic && !std::exchange(done, true)) {
        const auto part = message.instantiate<self_awareness::ModelPart>();
        change(part->bytes);
        damaged.write(topic, message.getTime(), *part);
      } else {
        damaged.write(message.getTopic(), message.getTime(), message);
      }
    });
  }
  // Gives a text in a part another name of the same length, where it comes first.
  static auto rename(const std::string& text, const std::string& name) {
    return [=](std::vector<std::uint8_t>& bytes) {
      const auto at = std::search(bytes.begin(), bytes.end(), text.begin(), text.end());
      ASSERT_NE(at, bytes.end()) << text;
      std::copy(name.begin(), name.end(), at);
    };
  }
  // The same, of a model that a test has changed and nobody has looked at.
  template <typename Change>
  std::string damagedModel(Change change) {
    return damagedPart("/model", [&](std::vector<std::uint8_t>& bytes) {
      TrainedModel model = calibratedModel();
      change(model);
      ByteWriter written;
      writeModel(model, written);
      bytes = written.take();
    });
  }
};

}  // namespace self_awareness::ros1
