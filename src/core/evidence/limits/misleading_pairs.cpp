#include "core/evidence/limits/misleading_pairs.h"

#include <algorithm>
#include <limits>

#include "core/evidence/channel/channel.h"
#include "core/evidence/count/bin_arrays.h"
#include "core/evidence/watch/gain.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kNotSeen = std::numeric_limits<std::int64_t>::min();

}  // namespace

MisleadingPairs::MisleadingPairs(const Model& model)
    : tuning_(model.tuning()), pairs_(model.size()), said_(model.tracks().size(), Said::kNothing) {
  const Statistics& training = model.statistics();
  const InformationGain gain(training, training, tuning_.fewest_gaps);
  const std::vector<SumOfDelays> to_any = training.delaysToAny();
  for (std::size_t track = 0; track < model.tracks().size(); ++track) {
    const auto& [channel, to, from] = model.tracks()[track];
    if (!channel->mayMislead()) {
      continue;
    }
    Pair pair;
    pair.from = from;
    pair.track = track;
    const ByBin of_pair = logProbabilities(training.delays(from, to));
    const ByBin of_any = logProbabilities(to_any[from]);
    asArray(pair.log_ratios) = asArray(of_pair) - asArray(of_any);
    pair.usual_gain = gain(from, to);
    pairs_[to].push_back(pair);
  }
  startPart();
}

void MisleadingPairs::add(const Event& event) {
  if (started_) {
    duration_ += std::max<std::int64_t>(event.stamp - newest_stamp_, 0);
    newest_stamp_ = std::max(newest_stamp_, event.stamp);
  } else {
    newest_stamp_ = event.stamp;
    started_ = true;
  }
  for (Pair& pair : pairs_[event.id]) {
    if (last_seen_[pair.from] != kNotSeen) {
      ++pair.delays[log_bins::bin(event.stamp - last_seen_[pair.from])];
    }
  }
  last_seen_[event.id] = event.stamp;
  if (duration_ >= toNanoseconds(tuning_.shortest_part)) {
    closePart();
  }
}

void MisleadingPairs::finish() {
  closePart();
}

std::vector<Said> MisleadingPairs::takeFindings() {
  std::vector<Said> said(said_.size(), Said::kNothing);
  said.swap(said_);
  return said;
}

void MisleadingPairs::startPart() {
  last_seen_.assign(pairs_.size(), kNotSeen);
  duration_ = 0;
  started_ = false;
  for (std::vector<Pair>& pairs : pairs_) {
    for (Pair& pair : pairs) {
      pair.delays.fill(0);
    }
  }
}

void MisleadingPairs::closePart() {
  for (const std::vector<Pair>& pairs : pairs_) {
    for (const Pair& pair : pairs) {
      const auto delays = asArray(pair.delays).cast<double>();
      const double number = delays.sum();
      if (number < tuning_.fewest_gaps) {
        continue;
      }
      const double gain = (delays * asArray(pair.log_ratios)).sum() / number;
      const Said said =
          gain < tuning_.least_gain_left * pair.usual_gain ? Said::kMisleading : Said::kAsUsual;
      said_[pair.track] = std::max(said_[pair.track], said);
    }
  }
  startPart();
}

}  // namespace self_awareness::core::evidence
