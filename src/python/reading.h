#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <optional>

#include "self_awareness/ros/bag_reader.h"

/// What the parts of the Python module that read bags share.
namespace self_awareness::python {

namespace py = pybind11;

// The progress bar lives in Python, and Ctrl-C must get through while C++ reads.
inline ros1::BagReader::Progress progressTo(const py::object& callback) {
  return [&callback](std::uint64_t done, std::uint64_t all) {
    if (PyErr_CheckSignals() != 0) {
      throw py::error_already_set();
    }
    if (!callback.is_none()) {
      callback(done, all);
    }
  };
}

inline ros1::TimeRange timeRange(std::optional<double> start, std::optional<double> end) {
  ros1::TimeRange range{start, end};
  range.validate();
  return range;
}

}  // namespace self_awareness::python
