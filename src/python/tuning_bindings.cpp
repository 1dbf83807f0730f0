#include <pybind11/operators.h>
#include <pybind11/stl.h>

#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "self_awareness/core/evidence/channel/track.h"
#include "self_awareness/core/evidence/tuning.h"

namespace self_awareness::python {
namespace {

using core::evidence::Tuning;
using core::evidence::TuningNumber;
using TuningState = std::pair<std::vector<double>, std::set<std::string>>;

TuningState stateOfTuning(const Tuning& tuning) {
  TuningState state;
  for (const TuningNumber& number : core::evidence::tuningNumbers()) {
    state.first.push_back(tuning.*number.value);
  }
  state.second = tuning.without;
  return state;
}

Tuning tuningFrom(const TuningState& state) {
  Tuning tuning;
  const std::vector<TuningNumber>& numbers = core::evidence::tuningNumbers();
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    tuning.*numbers[k].value = state.first.at(k);
  }
  tuning.without = state.second;
  return tuning;
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
      .def_static("numbers", [] { return core::evidence::tuningNumbers(); })
      .def_static(
          "channels", [] { return core::evidence::channelNames(); },
          "names of the channels that can be switched off")
      .def(
          "get",
          [](const Tuning& self, const std::string& name) {
            return self.*core::evidence::tuningNumber(name).value;
          },
          py::arg("name"), "ValueError if there is no number of this name.")
      .def(
          "set",
          [](Tuning& self, const std::string& name, double value) {
            core::evidence::set(self, name, value);
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
            if (core::evidence::channelNamed(channel) == nullptr) {
              throw std::invalid_argument("the method has no channel '" + channel + "'");
            }
            self.without.insert(channel);
          },
          py::arg("channel"), "Switches a channel off. ValueError if there is none of this name.")
      .def(py::self == py::self)
      .def(py::pickle(&stateOfTuning, &tuningFrom));
}

}  // namespace self_awareness::python
