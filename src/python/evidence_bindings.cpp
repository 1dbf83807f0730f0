#include <pybind11/operators.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "core/evidence/channel/scorer.h"
#include "core/evidence/count/log_bins.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/evidence/channel/track.h"
#include "self_awareness/core/evidence/tuning.h"
#include "self_awareness/core/evidence/watch/relation.h"
#include "self_awareness/ros/model/model_file.h"

namespace self_awareness::python {
namespace {

namespace evidence = core::evidence;

using evidence::Tuning;
using evidence::TuningNumber;
using TuningState = std::pair<std::vector<double>, std::set<std::string>>;

TuningState stateOfTuning(const Tuning& tuning) {
  TuningState state;
  for (const TuningNumber& number : evidence::tuningNumbers()) {
    state.first.push_back(tuning.*number.value);
  }
  state.second = tuning.without;
  return state;
}

Tuning tuningFrom(const TuningState& state) {
  Tuning tuning;
  const std::vector<TuningNumber>& numbers = evidence::tuningNumbers();
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    tuning.*numbers[k].value = state.first.at(k);
  }
  tuning.without = state.second;
  return tuning;
}

/// The evidence of every track at the end of every window.
class EvidenceRows : public core::WindowObserver {
 public:
  EvidenceRows(const std::shared_ptr<const evidence::Model>& model, std::int64_t window,
               const std::optional<std::vector<double>>& limits)
      : model_(*model), scorer_(model, window), window_(window) {
    if (!limits) {
      return;
    }
    if (limits->size() != model->tracks().size()) {
      throw std::invalid_argument("limits: one of each track is needed");
    }
    scorer_.capAt({*limits, {}});
  }

  std::optional<core::ObservedEvent> observe(const core::Event& event) override {
    if (model_.vocabulary().tellsMode(event.id)) {
      scorer_.enter(event);
      return std::nullopt;
    }
    if (!model_.vocabulary().isMessage(event.id)) {
      return std::nullopt;
    }
    return core::ObservedEvent{event, !model_.knows(event.id), scorer_.add(event)};
  }
  void close(const core::Window& window, std::int64_t /*end*/) override {
    const std::vector<double>& evidence = scorer_.closeWindow(window.start + window_);
    rows_.insert(rows_.end(), evidence.begin(), evidence.end());
  }
  void onClockStep() override { scorer_.restart(); }

  const std::vector<double>& rows() const { return rows_; }

 private:
  const evidence::Model& model_;
  evidence::Scorer scorer_;
  std::int64_t window_;
  std::vector<double> rows_;
};

/// Evidence of a recording, [windows, tracks].
py::array_t<double> evidenceOf(const std::shared_ptr<evidence::Model>& model, std::int64_t window,
                               const Stamps& stamps, const Ids& ids,
                               const std::optional<std::vector<double>>& limits) {
  EvidenceRows observer(model, window, limits);
  core::Windows windows(window, observer);
  forEachEvent(stamps, ids, {}, [&](const core::Event& event) { windows.add(event); });
  windows.finish();
  const std::size_t tracks = model->tracks().size();
  const std::vector<double>& rows = observer.rows();
  py::array_t<double> array({tracks == 0 ? 0 : rows.size() / tracks, tracks});
  std::copy(rows.begin(), rows.end(), array.mutable_data());
  return array;
}

/// Counts of all pairs of event types, of a half of the training or of both.
std::shared_ptr<evidence::Model> ofAllPairs(const ros1::TrainedModel& trained,
                                            std::optional<std::size_t> half) {
  if (!trained.hasEvidence()) {
    throw std::invalid_argument("the counts of all pairs were not loaded");
  }
  if (half.value_or(0) > 1) {
    throw std::invalid_argument("a training has the halves 0 and 1");
  }
  using Learned = evidence::Model::Learned;
  return std::make_shared<evidence::Model>(evidence::Watched{{}, trained.evidence, trained.tuning},
                                           !half        ? Learned::kBoth
                                           : *half == 0 ? Learned::kFirst
                                                        : Learned::kSecond);
}

/// Delays of a pair of event types: shortest delay [ns] and count by bin.
std::vector<std::pair<std::int64_t, std::uint32_t>> delaysOf(const evidence::Model& model,
                                                             core::EventId from,
                                                             core::EventId to) {
  const evidence::DelayHistogram& counts = model.learned().delays(from, to);
  std::vector<std::pair<std::int64_t, std::uint32_t>> delays;
  for (std::size_t bin = 0; bin < counts.size(); ++bin) {
    delays.emplace_back(evidence::log_bins::lowerEdge(bin), counts[bin]);
  }
  return delays;
}

}  // namespace

void bindTuning(py::module& m) {
  py::class_<TuningNumber>(m, "TuningNumber", "What is known of a number of the method.")
      .def_readonly("name", &TuningNumber::name)
      .def_property_readonly("default",
                             [](const TuningNumber& self) { return Tuning{}.*self.value; })
      .def_readonly("least", &TuningNumber::least, "smallest value that makes sense")
      .def_readonly("most", &TuningNumber::most, "largest one")
      .def_readonly("unit", &TuningNumber::unit, "empty: a pure number")
      .def_readonly("meaning", &TuningNumber::meaning, "a sentence")
      .def_readonly("off", &TuningNumber::off,
                    "with which its rule is switched off; None: it cannot be");

  py::class_<Tuning>(m, "Tuning", "Every number of the evidence detector's method.")
      .def(py::init<>(), "The defaults.")
      .def_static("numbers", [] { return evidence::tuningNumbers(); })
      .def_static(
          "channels", [] { return evidence::channelNames(); },
          "names of the channels that can be switched off")
      .def(
          "get",
          [](const Tuning& self, const std::string& name) {
            return self.*evidence::tuningNumber(name).value;
          },
          py::arg("name"), "ValueError if there is no number of this name.")
      .def(
          "set",
          [](Tuning& self, const std::string& name, double value) {
            evidence::set(self, name, value);
          },
          py::arg("name"), py::arg("value"),
          "ValueError if there is no number of this name, or the value is out of its range.")
      .def_property_readonly("without",
                             [](const Tuning& self) {
                               return std::vector<std::string>(self.without.begin(),
                                                               self.without.end());
                             })
      .def(
          "leave_out",
          [](Tuning& self, const std::string& channel) {
            if (evidence::channelNamed(channel) == nullptr) {
              throw std::invalid_argument("the method has no channel '" + channel + "'");
            }
            self.without.insert(channel);
          },
          py::arg("channel"), "Switches a channel off. ValueError if there is none of this name.")
      .def(py::self == py::self)
      .def(py::pickle(&stateOfTuning, &tuningFrom));
}

void bindEvidence(py::module& m) {
  using evidence::Track;
  py::class_<Track>(m, "Track", "One thing that the evidence detector watches.")
      .def_property_readonly(
          "channel", [](const Track& self) { return evidence::channelLabel(self); },
          "as people read it: overdue, pace, pairs, deadlines or its own")
      .def_property_readonly(
          "name", [](const Track& self) { return evidence::channelName(self); },
          "of the channel (Tuning.channels)")
      .def_readonly("to_id", &Track::to)
      .def_readonly("from_id", &Track::from,
                    "same as to_id if the channel looks at one event type");

  py::class_<evidence::Model, std::shared_ptr<evidence::Model>>(
      m, "EvidenceModel", "What normal operation lets expect, from a TrainedModel's counts.")
      .def(py::init([](const ros1::TrainedModel& trained) {
             trained.requireWatched();
             return std::make_shared<evidence::Model>(trained.watched);
           }),
           py::arg("trained"))
      .def_static(
          "of_all_pairs", &ofAllPairs, py::arg("trained"), py::arg("half") = py::none(),
          "What was counted of all pairs, not only of those that are watched; it has no\n"
          "tracks. half: of the training, 0 or 1; None: both. ValueError if the model was\n"
          "not trained for the evidence detector, or only a part of it was loaded.")
      .def_property_readonly("tracks", &evidence::Model::tracks)
      .def_property_readonly(
          "duration", [](const evidence::Model& self) { return self.learned().duration(); },
          "of the recordings [ns]")
      .def(
          "events",
          [](const evidence::Model& self, core::EventId id) {
            return self.learned().type(id).events;
          },
          py::arg("id"))
      .def(
          "rate_variance",
          [](const evidence::Model& self, core::EventId id) {
            return self.learned().rateVariance(id);
          },
          py::arg("id"), "variance of the number of events in RATE_SPAN")
      .def(
          "dispersion",
          [](const evidence::Model& self, core::EventId id) {
            return self.learned().dispersion(id);
          },
          py::arg("id"), "how many events of a type say as much as one that is independent")
      .def(
          "delay_count",
          [](const evidence::Model& self, core::EventId from, core::EventId to) {
            return self.learned().total(from, to);
          },
          py::arg("from_id"), py::arg("to_id"), "number of delays")
      .def(
          "usual_delay",
          [](const evidence::Model& self, core::EventId from, core::EventId to, double share) {
            return self.usualDelay(from, to, share) * 1e-9;
          },
          py::arg("from_id"), py::arg("to_id"), py::arg("share"),
          "delay [s] that this share (0 to 1) of the delays in training did not exceed,\n"
          "as exactly as the bins are")
      .def("delays", &delaysOf, py::arg("from_id"), py::arg("to_id"),
           "counts of the delays in training, of what is watched: list of (shortest delay [ns],\n"
           "count) by bin; zeros for other pairs")
      .def("evidence", &evidenceOf, py::arg("window"), py::arg("stamps"), py::arg("ids"),
           py::arg("limits") = py::none(),
           "Evidence at the end of every window of a recording: float64 [windows, tracks].\n"
           "limits: by track, which sums end a little above; NaN: not judged. None: not known.");

  m.attr("RATE_SPAN") = evidence::kRateSpan;  // [ns]

  py::class_<evidence::Relation>(m, "Relation", "What speaks for a relation.")
      .def_readonly("watched", &evidence::Relation::watched)
      .def_readonly("reaches", &evidence::Relation::reaches)
      .def_readonly("irregular", &evidence::Relation::irregular)
      .def_readonly("spread", &evidence::Relation::spread)
      .def_readonly("starts", &evidence::Relation::starts)
      .def_readonly("starts_needed", &evidence::Relation::starts_needed);
}

}  // namespace self_awareness::python
