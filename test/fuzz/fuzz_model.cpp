// Loads a model, and lets both detectors judge some seconds by it: a model that is accepted must
// be one that can be used.

#include <memory>
#include <stdexcept>

#include "fuzzed_file.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/evidence/judge.h"
#include "self_awareness/core/paper/judge.h"
#include "self_awareness/core/verdict/detector.h"
#include "self_awareness/ros/model/model_file.h"

using namespace self_awareness;  // NOLINT

namespace {

void judge(std::unique_ptr<core::Judge> judge, const ros1::TrainedModel& model) {
  core::Detector::Parameters parameters;
  parameters.settle_time = 0;
  core::Detector detector(std::move(judge), model.window, parameters, [](const core::Verdict&) {});
  constexpr std::int64_t kStep = 37000000;
  std::int64_t now = 0;
  for (core::EventId id = 0; id < 50; ++id) {
    detector.add({now += kStep, id % 5});
  }
  detector.finish();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::FuzzedFile file(data, size);
  try {
    const ros1::TrainedModel model = ros1::loadModel(file.path());
    // Larger ones take longer than a fuzzer should, and judge in the same way.
    if (model.vocabulary().size() > 20) {
      return 0;
    }
    if (model.isWatched()) {
      judge(core::evidence::makeJudge(std::make_shared<core::evidence::Model>(model.watched),
                                      model.limits(), model.window,
                                      std::make_shared<core::SourceGraph>(model.graph),
                                      std::make_shared<core::Vocabulary>(model.vocabulary())),
            model);
    }
    if (model.hasDelays()) {
      judge(core::paper::makeJudge(std::make_shared<core::paper::Model>(model.statistics),
                                   model.threshold(), true),
            model);
    }
  } catch (const ros1::ModelFileError&) {
  }
  return 0;
}
