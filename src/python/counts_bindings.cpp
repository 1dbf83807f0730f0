#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>

#include "bindings.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/ros/model/model_file.h"

namespace self_awareness::python {
namespace {

namespace evidence = core::evidence;

/// What a training, or one half of it, counted of all pairs of event types.
class EvidenceCounts {
 public:
  EvidenceCounts(const ros1::TrainedModel& trained, std::optional<std::size_t> half)
      : model_({{}, trained.evidence, trained.tuning}, learnedOf(half)),
        counts_(half ? trained.evidence.at(*half) : model_.statistics()) {}

  const evidence::Statistics& counts() const { return counts_; }
  const evidence::Model& model() const { return model_; }
  /// Variance of the number of events of a type in kRateSpan.
  double rateVariance(core::EventId id) const {
    const auto windows = static_cast<double>(std::max<std::uint64_t>(counts_.rateWindows(), 1));
    const evidence::Statistics::Type& type = counts_.type(id);
    const double mean = static_cast<double>(type.rate_sum) / windows;
    return std::max(static_cast<double>(type.rate_squares) / windows - mean * mean, 0.0);
  }

 private:
  static evidence::Model::Learned learnedOf(std::optional<std::size_t> half) {
    using Learned = evidence::Model::Learned;
    return !half ? Learned::kBoth : *half == 0 ? Learned::kFirst : Learned::kSecond;
  }

  evidence::Model model_;
  evidence::Statistics counts_;
};

}  // namespace

void bindCounts(py::module& m) {
  using Counts = EvidenceCounts;
  py::class_<Counts>(m, "EvidenceCounts", "What a training, or a half of it, counted.")
      .def(py::init([](const ros1::TrainedModel& trained, std::optional<std::size_t> half) {
             if (!trained.hasEvidence()) {
               throw std::invalid_argument("the counts of all pairs were not loaded");
             }
             return std::make_unique<Counts>(trained, half);
           }),
           py::arg("trained"), py::arg("half") = py::none(),
           "half: 0 or 1; None: both. ValueError if the model was not trained for the evidence\n"
           "detector, or only a part of it was loaded.")
      .def_property_readonly(
          "duration", [](const Counts& self) { return self.counts().duration(); }, "[ns]")
      .def(
          "events",
          [](const Counts& self, core::EventId id) { return self.counts().type(id).events; },
          py::arg("id"))
      .def("rate_variance", &Counts::rateVariance, py::arg("id"),
           "variance of the number of events in RATE_SPAN")
      .def(
          "delay_count",
          [](const Counts& self, core::EventId from, core::EventId to) {
            return self.counts().total(from, to);
          },
          py::arg("from_id"), py::arg("to_id"), "number of delays")
      .def(
          "delays",
          [](const Counts& self, core::EventId from, core::EventId to) {
            return delaysOf(self.counts(), from, to);
          },
          py::arg("from_id"), py::arg("to_id"), "list of (shortest delay [ns], count) by bin")
      .def(
          "usual_delay",
          [](const Counts& self, core::EventId from, core::EventId to, double share) {
            return self.model().usualDelay(from, to, share) * 1e-9;
          },
          py::arg("from_id"), py::arg("to_id"), py::arg("share"),
          "delay [s] that this share (0 to 1) of the delays did not exceed; as of EvidenceModel");
  m.attr("RATE_SPAN") = evidence::kRateSpan;  // [ns]
}

}  // namespace self_awareness::python
