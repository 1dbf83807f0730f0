#include "self_awareness/ros/bag/bag_reader.h"

#include <rosbag/exceptions.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "../message_field.h"
#include "../text.h"
#include "bag_messages.h"
#include "open_bag.h"
#include "recording_files.h"
#include "self_awareness/ros/attribute_reader.h"
#include "self_awareness/ros/own_output.h"
#include "version_of_bag.h"

namespace self_awareness::ros1 {
namespace {

constexpr std::uint64_t kMessagesPerProgress = 10000;

// FNV-1a, 64 bit.
std::uint64_t hash(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  }
  return hash;
}

// The finaliser of SplitMix64: every bit of the value changes half of the bits.
std::uint64_t mix(std::uint64_t value) {
  value = (value ^ value >> 30) * 0xbf58476d1ce4e5b9;
  value = (value ^ value >> 27) * 0x94d049bb133111eb;
  return value ^ value >> 31;
}

// Names the recording; it is no protection. A sum, so the order of messages with the same stamp
// does not matter: another program may write them in another order.
std::uint64_t fingerprint(const BagIndex& index) {
  std::vector<std::uint64_t> topics;
  topics.reserve(index.connections.size());
  for (const Connection& connection : index.connections) {
    topics.push_back(hash(connection.topic));
  }
  std::uint64_t sum = 0;
  for (const BagIndexEntry& entry : index.entries) {
    sum += mix(topics[entry.connection] + static_cast<std::uint64_t>(entry.stamp));
  }
  return sum;
}

bool topicsAreDistinct(const BagIndex& index) {
  std::set<std::string> topics;
  return std::all_of(
      index.connections.begin(), index.connections.end(),
      [&](const Connection& connection) { return topics.insert(connection.topic).second; });
}

Siblings siblingsIn(const BagIndex& index) {
  Siblings siblings;
  for (const Connection& connection : index.connections) {
    siblings.add(connection.callerid, connection.datatype);
  }
  return siblings;
}

std::vector<std::string> reasonsOf(const std::vector<Connection>& connections) {
  std::set<std::string> reasons;
  for (const Connection& connection : connections) {
    const std::string reason = whyLeftOut(connection);
    if (!reason.empty() && reasons.size() < BagSummary::kMostReasons) {
      reasons.insert(reason);
    }
  }
  return {reasons.begin(), reasons.end()};
}

// ROS time has 32 bits for the seconds.
std::int64_t fromSeconds(double seconds) {
  return std::llround(std::min(seconds, 0x1p32) * 1e9);
}

}  // namespace

void TimeRange::validate() const {
  if ((start && !(*start >= 0)) || (end && !(*end > start.value_or(0)))) {
    throw std::invalid_argument(
        "a time range must have 0 <= start < end, in seconds from the recording's start");
  }
}

StampRange::StampRange(const BagSummary& summary, const TimeRange& range) {
  range.validate();
  first = summary.start + fromSeconds(range.start.value_or(0));
  last = range.end ? std::min(summary.start + fromSeconds(*range.end), summary.end) : summary.end;
  if (first > summary.end) {
    throw BagError(summary.path + ": the time range begins after the recording's end (" +
                   std::to_string(core::toSeconds(summary.end - summary.start)) + " s)");
  }
}

std::set<core::EventType> eventTypesIn(const std::vector<std::string>& paths,
                                       const Encoder& encoder) {
  std::set<core::EventType> types;
  for (const std::string& path : paths) {
    std::vector<Connection> connections;
    try {
      connections = readBagConnections(path);
    } catch (const rosbag::BagException&) {
      connections = openBag(path).connections;  // says what is wrong
    }
    for (const Connection& connection : connections) {
      if (std::optional<core::EventType> type = encoder.typeOf(connection)) {
        types.insert(std::move(*type));
      }
    }
  }
  return types;
}

BagReader::BagReader(const std::string& path, const Progress& progress)
    : BagReader(std::vector<std::string>{path}, progress) {}

BagReader::BagReader(const std::vector<std::string>& paths, const Progress& progress)
    : files_(std::make_unique<const RecordingFiles>(paths, progress)) {
  const BagIndex& index = files_->index();
  summary_.path = nameOf(paths);
  if (isEventLog(paths.front(), index)) {
    throw BagError(
        summary_.path +
        ": an event log, not a bag of the robot's messages; its recordings have numbers");
  }
  if (index.entries.empty()) {
    throw BagError(summary_.path +
                   (index.timeless > 0
                        ? ": all its messages have the time 0; write it again, "
                          "with the times at which they came"
                        : ": the bag is empty: it holds no messages; leave it out"));
  }
  summary_.bag = printable(summary_.path.substr(summary_.path.rfind('/') + 1));
  summary_.files = files_->files();
  summary_.set_back = files_->setBack();
  summary_.start = index.entries.front().stamp;
  summary_.end = index.entries.back().stamp;
  summary_.messages = index.entries.size();
  summary_.fingerprint = fingerprint(index);
  summary_.has_sources =
      std::any_of(index.connections.begin(), index.connections.end(),
                  [](const Connection& connection) { return !connection.callerid.empty(); });
  summary_.one_sender_a_topic = index.by_python && topicsAreDistinct(index);
  summary_.copied = summary_.one_sender_a_topic && index.recorded;
  summary_.left_out = reasonsOf(index.connections);
  if (index.timeless > 0) {
    summary_.left_out.push_back("what has the time 0 (" + std::to_string(index.timeless) +
                                " messages)");
  }
}

BagReader::~BagReader() = default;

void BagReader::read(const Encoder& encoder, const TimeRange& range, const Handler& handler,
                     const Progress& progress, const SenderWatch::Handler& senders) const {
  const StampRange stamps(summary_, range);
  struct Heard {
    std::optional<ConnectionEncoder> encoder;  // none: left out
    AttributeReader attributes;
    std::shared_ptr<SenderWatch::Link> link;  // none: nothing is to be learned of it
  };
  std::vector<Heard> all;  // by connection
  std::optional<SenderWatch> watch;
  if (senders) {
    watch.emplace(senders);
  }
  const Siblings siblings = encoder.tellsSources() ? siblingsIn(files_->index()) : Siblings();
  for (const Connection& connection : files_->index().connections) {
    all.push_back(
        {siblings.cover(connection.callerid, connection.topic) ? std::nullopt
                                                               : encoder.connect(connection),
         AttributeReader(connection), watch ? watch->connect(connection, encoder) : nullptr});
  }
  std::vector<std::uint8_t> content;
  std::vector<core::EventId> latched;  // what lasts when the range begins
  std::uint64_t done = 0;
  withMessages([&](RecordingFiles::Messages messages) {
    for (const BagIndexEntry& entry : files_->index().entries) {
      if (progress && done % kMessagesPerProgress == 0) {
        progress(done, summary_.messages);
      }
      ++done;
      if (entry.stamp > stamps.last) {
        continue;
      }
      auto& [connection_encoder, reader, link] = all[entry.connection];
      if (!connection_encoder) {
        if (link && stamps.holds(entry.stamp)) {
          watch->add(entry.stamp, *link, std::nullopt);
        }
        continue;
      }
      const bool accepted = connection_encoder->accept();
      if (const auto id = accepted ? std::nullopt : connection_encoder->latched()) {
        latched.push_back(*id);
      }
      if (!stamps.holds(entry.stamp)) {
        continue;
      }
      for (const core::EventId id : std::exchange(latched, {})) {
        handler({entry.stamp, id, {}});
      }
      const BagIndexEntry stored = asStored(entry, summary_.set_back);
      const bool tells_mode = connection_encoder->tellsMode();
      const bool needs_content = tells_mode || (accepted && connection_encoder->needsContent());
      if (needs_content) {
        messages.read(stored, content);
      }
      const core::Attributes found =
          needs_content ? reader.read(content, stored.stamp) : messages.attributes(stored, reader);
      if (link) {
        // A copy has the messages of all senders of a topic under one name.
        watch->add(entry.stamp, *link,
                   summary_.one_sender_a_topic ? std::nullopt : reader.number());
      }
      if (tells_mode) {
        handler({entry.stamp, connection_encoder->mode(content.data(), content.size())});
      }
      if (const auto id =
              accepted && needs_content
                  ? connection_encoder->list(content.data(), content.size(), entry.stamp)
                  : std::nullopt) {
        handler({entry.stamp, *id, {}});
      }
      if (accepted) {
        handler({entry.stamp,
                 needs_content ? connection_encoder->id(content.data(), content.size())
                               : connection_encoder->id(),
                 found});
      }
    }
  });
  if (progress) {
    progress(done, summary_.messages);
  }
}

std::map<std::string, std::vector<double>> BagReader::readNumbers(const EncodingRules& rules,
                                                                  const TimeRange& range) const {
  const StampRange stamps(summary_, range);
  EncodingRules plain = rules;  // whose events are those of the same messages
  plain.type_fields.clear();
  plain.classes.clear();
  plain.mode.reset();
  const Encoder encoder(plain, nullptr);
  struct Read {
    ConnectionEncoder encoder;
    MessageField field;
    std::vector<double>& numbers;
  };
  std::map<std::string, std::vector<double>> numbers;
  std::vector<std::optional<Read>> reads;
  for (const Connection& connection : files_->index().connections) {
    const auto classes = rules.classes.find(connection.datatype);
    std::optional<ConnectionEncoder> connected =
        classes == rules.classes.end() ? std::nullopt : encoder.connect(connection);
    reads.emplace_back();
    if (connected) {
      reads.back().emplace(Read{
          *connected,
          MessageField(connection.definition, connection.datatype,
                       rules.type_fields.at(connection.datatype), MessageField::Kind::kNumber),
          numbers[connection.datatype]});
    }
  }
  std::vector<std::uint8_t> content;
  withMessages([&](RecordingFiles::Messages messages) {
    for (const BagIndexEntry& entry : files_->index().entries) {
      std::optional<Read>& read = reads[entry.connection];
      if (read && read->encoder.accept() && stamps.holds(entry.stamp)) {
        messages.read(asStored(entry, summary_.set_back), content);
        read->numbers.push_back(read->field.number(content.data(), content.size()));
      }
    }
  });
  return numbers;
}

template <typename Use>
void BagReader::withMessages(const Use& use) const {
  try {
    use(RecordingFiles::Messages(*files_));
  } catch (const std::out_of_range& error) {
    throw BagError(summary_.path + ": " + error.what());
  }
}

}  // namespace self_awareness::ros1
