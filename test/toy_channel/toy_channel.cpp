#include "toy_channel.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "self_awareness/core/evidence/channel/model.h"

namespace self_awareness::core::evidence {
namespace {

constexpr double kFewestAtOnce = 4;

class BurstsState : public ChannelState {
 public:
  BurstsState(const Model& model, const std::vector<std::size_t>& tracks)
      : model_(model), tracks_(tracks), open_(model.size(), 0), closed_(model.size(), 0) {}

  bool listens() const override { return true; }
  void add(const Heard::Arrival& arrival, const Heard& /*heard*/) override {
    open_[arrival.id] += arrival.stalled ? 0 : 1;
  }
  void restart() override { std::fill(open_.begin(), open_.end(), 0); }
  void closeWindow(const Heard& /*heard*/, std::vector<double>& evidence) override {
    open_.swap(closed_);
    restart();
    for (const std::size_t track : tracks_) {
      evidence[track] = closed_[model_.tracks()[track].to];
    }
  }
  // No later window says it again.
  bool isCertain(std::size_t /*track*/, double /*limit*/, const Heard& /*heard*/) const override {
    return true;
  }
  void explain(std::size_t /*track*/, const Heard& /*heard*/, const RecentEvents& /*events*/,
               Suspect& suspect) const override {
    const int at_once = closed_[suspect.id];
    suspect.reason.kind = Kind::kFast;
    suspect.reason.unit = "at once";
    suspect.reason.value = at_once;
    char text[80];
    std::snprintf(text, sizeof text, "%d at once, usually one every %.3f s", at_once,
                  model_.meanGap(suspect.id) * 1e-9);
    suspect.reason.words = text;
  }

 private:
  const Model& model_;
  const std::vector<std::size_t>& tracks_;
  std::vector<int> open_;    // events of the window, by id
  std::vector<int> closed_;  // of the one before
};

class ExpectedBursts : public Expectation {
 public:
  ExpectedBursts(const Model& model, std::vector<std::size_t> tracks)
      : Expectation(std::move(tracks)), model_(model) {}

  std::unique_ptr<ChannelState> start() const override {
    return std::make_unique<BurstsState>(model_, tracks());
  }
  double leastLimit(std::size_t /*track*/) const override { return kFewestAtOnce; }

 private:
  const Model& model_;
};

}  // namespace

std::vector<Track> Bursts::watch(const Choice& choice) const {
  std::vector<Track> tracks;
  for (EventId id = 0; id < choice.both.size(); ++id) {
    if (choice.isJudged(id)) {
      tracks.push_back({this, id, id});
    }
  }
  return tracks;
}

std::unique_ptr<const Expectation> Bursts::expect(const Model& model, const Halves& /*halves*/,
                                                  std::vector<std::size_t> tracks) const {
  return std::make_unique<ExpectedBursts>(model, std::move(tracks));
}

}  // namespace self_awareness::core::evidence
