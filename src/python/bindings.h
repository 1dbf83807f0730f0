#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "self_awareness/core/evidence/limits/limits.h"
#include "self_awareness/core/learn.h"
#include "self_awareness/core/stream/clock.h"
#include "self_awareness/core/stream/clock_steps.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/verdict/acceptance.h"
#include "self_awareness/core/verdict/detector.h"
#include "self_awareness/core/verdict/source_graph.h"
#include "self_awareness/ros/bag/bag_reader.h"

/// What the parts of the Python module share.
PYBIND11_MAKE_OPAQUE(self_awareness::core::evidence::LimitFinder::Findings)

namespace self_awareness::python {

namespace py = pybind11;

using Stamps = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
using Ids = py::array_t<std::uint32_t, py::array::c_style | py::array::forcecast>;

/// A file, or the files of one recording, in their order.
using Files = std::variant<std::string, std::vector<std::string>>;

inline std::vector<std::string> pathsOf(const Files& files) {
  if (const auto* path = std::get_if<std::string>(&files)) {
    return {*path};
  }
  const auto& paths = std::get<std::vector<std::string>>(files);
  if (paths.empty()) {
    throw std::invalid_argument("a recording without a file");
  }
  return paths;
}

template <typename T>
py::array_t<T> toArray(const std::vector<T>& values) {
  return py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data());
}

inline py::array_t<bool> toArray(const std::vector<bool>& values) {
  py::array_t<bool> array(static_cast<py::ssize_t>(values.size()));
  std::copy(values.begin(), values.end(), array.mutable_data());
  return array;
}

/// The getter of an optional member: Python gets a copy. As a mere member (def_readonly),
/// pybind11 2.4 of Ubuntu 20.04 moves the value out of the object.
template <typename Class, typename Base, typename Value>
auto copyOf(std::optional<Value> Base::*member) {
  return [member](const Class& self) { return self.*member; };
}

/// An edge of a graph: publisher, topic, subscriber.
using EdgeState = std::tuple<std::string, std::string, std::string>;

inline core::SourceGraph graphOf(const std::set<EdgeState>& edges) {
  core::SourceGraph graph;
  for (const auto& [publisher, topic, subscriber] : edges) {
    graph.connect(publisher, topic, subscriber);
  }
  return graph;
}

/// @throw std::invalid_argument if no alarm is of this kind
inline core::Kind kindNamed(const std::string& name) {
  const std::optional<core::Kind> kind = core::kindOf(name);
  if (!kind) {
    throw std::invalid_argument(name + " is no kind of an alarm");
  }
  return *kind;
}

/// Computers by node, or by source.
using HostsState = std::map<std::string, std::string>;

/// The time of the wall clock, in whole seconds [ns]: when something was learned.
inline std::int64_t now() {
  return static_cast<std::int64_t>(std::time(nullptr)) * core::kNanosecondsPerSecond;
}

/// Attributes of messages (core::packed()), one for each event; none: nothing is known of them.
using MessageAttributes = std::optional<Ids>;

/// Calls the handler with every event of arrays: stamps [ns], ids and attributes.
/// @throw std::invalid_argument if the arrays are not of one dimension and the same length, or a
/// number is no attributes
template <typename Handler>
void forEachEvent(const Stamps& stamps, const Ids& ids, const MessageAttributes& attributes,
                  Handler handler) {
  if (stamps.ndim() != 1 || ids.ndim() != 1 || stamps.size() != ids.size() ||
      (attributes && (attributes->ndim() != 1 || attributes->size() != ids.size()))) {
    throw std::invalid_argument(
        "stamps, ids and attributes must be arrays of one dimension and length");
  }
  const auto stamp = stamps.unchecked<1>();
  const auto id = ids.unchecked<1>();
  const std::uint32_t* const packed = attributes ? attributes->data() : nullptr;
  for (py::ssize_t i = 0; i < stamps.size(); ++i) {
    handler(
        core::Event{stamp(i), id(i),
                    packed != nullptr ? core::unpackedAttributes(packed[i]) : core::Attributes{}});
  }
}

/// Tells a callback of Python, or None, how far a reader has come; Ctrl-C ends the reading.
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

/// Which subscriptions are missing from a time [ns] on.
using MissingStates =
    std::vector<std::pair<std::int64_t, std::set<core::SourceGraph::Subscription>>>;

/// Who sends from a time [ns] on, as far as events do not say it: what comes from two senders of
/// one name, and what is played.
using SenderState =
    std::tuple<std::int64_t, std::set<core::SourceGraph::Publication>, std::set<core::EventType>>;

/// A recording as arrays: recordings.RecordingEvents of Python, which says what is in it.
struct RecordingEvents {
  /// @throw pybind11::type_error if a part of it has another type
  explicit RecordingEvents(const py::object& recording);

  core::Recording recording;  // all that it has a place for, but for the events
  std::vector<core::EventType> event_types;
  Stamps stamps;
  Ids ids;
  MessageAttributes attributes;
  std::int64_t end = 0;  // [ns]; 0: with the last event
  std::optional<std::pair<Stamps, Ids>> before;
  MissingStates missing;
  std::vector<SenderState> senders;
  HostsState hosts;
};

/// Lets a detector judge a recording.
/// @param heard called after each event; whether it belongs to the same clock as those before
inline void judgeRecording(core::Detector& detector, const RecordingEvents& arrays,
                           const std::function<void(const core::Event&, bool)>& heard = nullptr) {
  const core::Recording& recording = arrays.recording;
  std::optional<std::int64_t> last;
  bool set_forward = false;
  auto next = recording.waiting.begin();
  auto next_missing = arrays.missing.begin();
  auto next_senders = arrays.senders.begin();
  const auto wait = [&](std::int64_t until) {
    next = core::hearUntil(until, next, recording.waiting.end(), detector);
    for (; next_missing != arrays.missing.end() && next_missing->first <= until; ++next_missing) {
      detector.setMissing(next_missing->second);
    }
    for (; next_senders != arrays.senders.end() && std::get<0>(*next_senders) <= until;
         ++next_senders) {
      detector.setSenders({std::get<1>(*next_senders), std::get<2>(*next_senders)});
    }
  };
  forEachEvent(arrays.stamps, arrays.ids, arrays.attributes, [&](const core::Event& event) {
    if (last && recording.clock_steps.between(*last, event.stamp)) {
      detector.restart();
      set_forward = true;
    }
    wait(event.stamp);
    const bool same_clock = detector.add(event) && !set_forward;
    set_forward = false;
    last = event.stamp;
    if (heard) {
      heard(event, same_clock);
    }
  });
  if (last && !core::isClockStep(*last, arrays.end)) {
    wait(arrays.end);
    detector.advance(arrays.end);  // silence until the end is part of the recording
  }
  detector.finish();
}

/// @throw std::invalid_argument if there are too many
core::Acceptances acceptancesOf(const std::vector<core::Acceptance>& list);

// What each file beside this one binds.
void bindAccepted(py::module& module);
void bindAlarms(py::module& module);
void bindDetector(py::module& module);
void bindDrift(py::module& module);
void bindEncoding(py::module& module);
void bindEventLogs(py::module& module);
void bindEvidence(py::module& module);
void bindFiles(py::module& module);
void bindIncidents(py::module& module);
void bindLanes(py::module& module);
void bindLearning(py::module& module);
void bindModel(py::module& module);
void bindRecordings(py::module& module);
void bindResults(py::module& module);
void bindTuning(py::module& module);

}  // namespace self_awareness::python
