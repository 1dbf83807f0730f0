#include "self_awareness/ros/bag/bag_to_event_log.h"

#include <utility>

#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/ros/bag/event_log_packer.h"
#include "self_awareness/ros/encoding_message.h"
#include "self_awareness/ros/ros_time.h"

namespace self_awareness::ros1 {

void addToEventLog(const BagReader& bag, const EncodingRules& rules, const Graph& graph,
                   EventLogWriter& log, const BagReader::Progress& progress) {
  const BagSummary& summary = bag.summary();
  self_awareness::EventLogStart start;
  start.encoding = toMessage(rules);
  start.begin = toRosTime(summary.start);
  start.bag = summary.bag;
  start.fingerprint = summary.fingerprint;
  start.has_sources = summary.has_sources;
  start.one_sender_a_topic = summary.one_sender_a_topic;
  start.copied = summary.copied;
  log.start(start);
  log.writeGraph(graph, summary.start);

  core::Vocabulary vocabulary;
  const Encoder encoder(rules, [&](const core::EventType& type) {
    const std::size_t before = vocabulary.size();
    const core::EventId id = vocabulary.intern(type);
    if (vocabulary.size() > before) {
      checkEventTypes(rules, vocabulary);
    }
    return id;
  });
  EventLogPacker packer([&](self_awareness::EventLog part) { log.write(std::move(part)); });
  bag.read(
      encoder, {}, [&](const core::Event& event) { packer.add(event, vocabulary); }, progress);
  packer.flush(summary.end);
}

}  // namespace self_awareness::ros1
