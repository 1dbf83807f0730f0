#pragma once

#include "bytes.h"
#include "self_awareness/core/model.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/model/model_file.h"

namespace self_awareness::ros1 {

// What a model file keeps of each struct, in this order. A later format adds fields behind the
// others of its struct, by has(): `if (bytes.has(7)) bytes(...)`.

/// Passes a struct to a ByteWriter, or takes it of a ByteReader.
template <typename Bytes, typename Value>
using Passed = typename Bytes::template Ref<Value>;

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

template <typename Bytes>
void fields(Bytes& bytes, Passed<Bytes, self_awareness::FileVersion> version) {
  bytes(version.kind, version.format, version.oldest_reader, version.method, version.package);
}

template <typename Bytes>
void fields(Bytes& bytes, Passed<Bytes, core::EventType> type) {
  bytes(type.source, type.scope, type.type);
}

template <typename Bytes>
void fields(Bytes& bytes, Passed<Bytes, core::SourceGraph::Edge> edge) {
  bytes(edge.publisher, edge.topic, edge.subscriber);
}

template <typename Bytes>
void fields(Bytes& bytes, Passed<Bytes, Rename> rename) {
  bytes(rename.pattern, rename.name);
}

template <typename Bytes>
void fields(Bytes& bytes, Passed<Bytes, ValueClasses> classes) {
  bytes(classes.number, classes.bounds);
}

template <typename Bytes>
void fields(Bytes& bytes, Passed<Bytes, ModeField> mode) {
  bytes(mode.topic, mode.field);
}

template <typename Bytes>
void fields(Bytes& bytes, Passed<Bytes, EncodingRules> rules) {
  bytes(rules.source, rules.renames, rules.include_topics, rules.exclude_topics,
        rules.include_sources, rules.exclude_sources, rules.type_fields, rules.classes,
        rules.mode);
}

template <typename Bytes>
void fields(Bytes& bytes, Passed<Bytes, core::RecordingInfo> recording) {
  bytes(recording.bag);
  passSpan(bytes, recording.start, recording.end);
  bytes(recording.events, recording.robot_start, recording.fingerprint, recording.robot);
}

template <typename Bytes>
void fields(Bytes& bytes, Passed<Bytes, core::paper::Calibration> calibration) {
  bytes(calibration.threshold, calibration.method, calibration.auc, calibration.true_positive_rate,
        calibration.false_positive_rate, calibration.normal_windows, calibration.faulty_windows,
        calibration.false_alarms_per_hour, calibration.normal, calibration.faulty,
        calibration.injected, calibration.stamp);
}

template <typename Bytes>
void fields(Bytes& bytes, Passed<Bytes, core::paper::Histogram::Entry> entry) {
  bytes(entry.bin, entry.count);
}

template <typename Bytes>
void fields(Bytes& bytes, Passed<Bytes, core::evidence::Relation> relation) {
  bytes(relation.watched, relation.reaches, relation.irregular, relation.spread, relation.starts,
        relation.starts_needed);
}

template <typename Bytes>
void fields(Bytes& bytes, Passed<Bytes, core::Calibration> calibration) {
  bytes(calibration.method, calibration.limits.tracks, calibration.limits.firsts,
        calibration.relations, calibration.budget, calibration.false_alarms_per_hour,
        calibration.windows, calibration.recordings, calibration.stamp);
}

template <typename Bytes>
void fields(Bytes& bytes, Passed<Bytes, core::evidence::LimitFinder::Recording::Part> part) {
  bytes(part.windows, part.evidence, part.longest_gaps);
}

/// All are of the training: what others say is kept by a Calibration.
template <typename Bytes>
void fields(Bytes& bytes, Passed<Bytes, core::evidence::LimitFinder::Recording> recording) {
  passSpan(bytes, recording.start, recording.end);
  bytes(recording.robot_start, recording.robot, recording.windows, recording.parts,
        recording.said);
}

template <typename Bytes>
void fields(Bytes& bytes, Passed<Bytes, core::evidence::AttributeCounts> counts) {
  bytes(counts.ages, counts.rises, counts.sizes, counts.steps, counts.repeats,
        counts.longest_repeat);
}

/// What was left out is of its pairs.
template <typename Bytes>
void fields(Bytes& bytes, Passed<Bytes, core::evidence::Statistics::Type> type) {
  bytes(type.events, type.gaps, type.gap_sum, type.longest_gaps, type.rate_sum, type.rate_squares,
        type.attributes);
}

template <typename Bytes>
void fields(Bytes& bytes, Passed<Bytes, core::evidence::Statistics::Recording> recording) {
  passSpan(bytes, recording.start, recording.end);
  bytes(recording.longest_silence, recording.longest_stall, recording.events,
        recording.longest_gaps, recording.firsts, recording.robot_start, recording.robot);
}

}  // namespace self_awareness::ros1
