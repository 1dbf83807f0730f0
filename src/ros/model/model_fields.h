#pragma once

#include "bytes.h"
#include "self_awareness/core/model.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/model/model_file.h"

namespace self_awareness::ros1 {

// What a model file keeps of each struct, in this order. A later format adds fields behind the
// others of its struct, by has(): `if (bytes.has(7)) bytes(...)`.

/// Two stamps, of which the second one is not the earlier.
inline void passSpan(ByteWriter& bytes, std::int64_t start, std::int64_t end) {
  bytes(start, std::max(start, end));
}
inline void passSpan(ByteReader& bytes, std::int64_t& start, std::int64_t& end) {
  constexpr std::int64_t kLeast = -(std::int64_t{1} << 61U);  // such that differences fit
  constexpr std::int64_t kMost = std::int64_t{1} << 62U;      // ROS time ends before
  bytes(start, end);
  check(kLeast <= start && start <= end && end <= kMost,
        "a recording of it ends before it starts, or at a time that cannot be");
}

/// Passes the members of a struct to a ByteWriter, or takes them from a ByteReader.
template <typename Bytes, typename Passed>
void fields(Bytes& bytes, Passed& of) {
  using Struct = std::remove_const_t<Passed>;
  using core::evidence::LimitFinder;
  using core::evidence::Statistics;
  if constexpr (std::is_same_v<Struct, self_awareness::FileVersion>) {
    bytes(of.kind, of.format, of.oldest_reader, of.method, of.package);
  } else if constexpr (std::is_same_v<Struct, core::EventType>) {
    bytes(of.source, of.scope, of.type);
  } else if constexpr (std::is_same_v<Struct, core::SourceGraph::Edge>) {
    bytes(of.publisher, of.topic, of.subscriber);
  } else if constexpr (std::is_same_v<Struct, Rename>) {
    bytes(of.pattern, of.name);
  } else if constexpr (std::is_same_v<Struct, ValueClasses>) {
    bytes(of.number, of.bounds);
  } else if constexpr (std::is_same_v<Struct, ModeField>) {
    bytes(of.topic, of.field);
  } else if constexpr (std::is_same_v<Struct, EncodingRules>) {
    bytes(of.source, of.renames, of.include_topics, of.exclude_topics, of.include_sources,
          of.exclude_sources, of.type_fields, of.classes, of.mode);
  } else if constexpr (std::is_same_v<Struct, core::RecordingInfo>) {
    bytes(of.bag);
    passSpan(bytes, of.start, of.end);
    bytes(of.events, of.robot_start, of.fingerprint, of.robot);
  } else if constexpr (std::is_same_v<Struct, core::paper::Calibration>) {
    bytes(of.threshold, of.method, of.auc, of.true_positive_rate, of.false_positive_rate,
          of.normal_windows, of.faulty_windows, of.false_alarms_per_hour, of.normal, of.faulty,
          of.injected, of.stamp);
  } else if constexpr (std::is_same_v<Struct, core::paper::Histogram::Entry>) {
    bytes(of.bin, of.count);
  } else if constexpr (std::is_same_v<Struct, core::evidence::Relation>) {
    bytes(of.watched, of.reaches, of.irregular, of.spread, of.starts, of.starts_needed);
  } else if constexpr (std::is_same_v<Struct, core::Calibration>) {
    bytes(of.method, of.limits.tracks, of.limits.firsts, of.relations, of.budget,
          of.false_alarms_per_hour, of.windows, of.recordings, of.stamp);
  } else if constexpr (std::is_same_v<Struct, LimitFinder::Recording::Part>) {
    bytes(of.windows, of.evidence, of.longest_gaps);
  } else if constexpr (std::is_same_v<Struct, LimitFinder::Recording>) {
    // All are of the training: what others say is kept by a Calibration.
    passSpan(bytes, of.start, of.end);
    bytes(of.robot_start, of.robot, of.windows, of.parts, of.said);
  } else if constexpr (std::is_same_v<Struct, core::evidence::AttributeCounts>) {
    bytes(of.ages, of.rises, of.sizes, of.steps, of.repeats, of.longest_repeat);
  } else if constexpr (std::is_same_v<Struct, Statistics::Type>) {
    // What was left out is of its pairs.
    bytes(of.events, of.gaps, of.gap_sum, of.longest_gaps, of.rate_sum, of.rate_squares,
          of.attributes);
  } else {
    static_assert(std::is_same_v<Struct, Statistics::Recording>);
    passSpan(bytes, of.start, of.end);
    bytes(of.longest_silence, of.longest_stall, of.events, of.longest_gaps, of.firsts,
          of.robot_start, of.robot);
  }
}

}  // namespace self_awareness::ros1
