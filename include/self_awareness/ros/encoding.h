#pragma once

#include <ros/datatypes.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <regex>
#include <string>
#include <unordered_map>
#include <vector>

#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/ros/message_field.h"

namespace self_awareness::ros1 {

/// How messages become events: the rules of the function f (paper, section IV-C; docs/method.md,
/// section 1.1). The model holds them, so training and the monitor cannot disagree. Patterns are
/// regular expressions that must match the whole name.
struct EncodingRules {
  enum class Source {
    kCallerId,  ///< the publisher's node name, without anonymous numbers
    kNone       ///< left out: replays by rosbag play, bags without callerids
  };

  Source source = Source::kCallerId;
  std::vector<std::string> include_topics;  ///< empty: all
  std::vector<std::string> exclude_topics;
  std::vector<std::string> include_sources;  ///< empty: all; no effect for Source::kNone
  std::vector<std::string> exclude_sources;
  std::map<std::string, std::string> type_fields;  ///< field by datatype

  /// Rules that suit most robots: everything but the monitor's own output, clocks, aggregated
  /// logs, bonds and tools that only look on.
  static EncodingRules defaults();
  /// @throw std::invalid_argument names the pattern that is no regular expression
  void validate() const;
};

bool operator==(const EncodingRules& a, const EncodingRules& b);

/// Most event types that one type field may make. Every pair of event types has a histogram: a
/// field with many values, such as an identifier, would fill the memory and teach nothing.
constexpr std::size_t kMostTypesOfField = 1000;

/// Checks that no type field makes too many event types.
/// @throw std::invalid_argument names the type field that makes more than kMostTypesOfField
void checkTypeFields(const EncodingRules& rules, const core::Vocabulary& vocabulary);

/// One publisher's connection to a topic, from a connection header, live or in a bag.
struct Connection {
  std::string callerid;
  std::string topic;
  std::string datatype;
  std::string definition;
  bool latching = false;
  std::string md5sum;  ///< of the definition
};

/// What a connection header says; fields that it lacks are empty.
Connection connectionFrom(const ros::M_string& header, const std::string& topic);

/// Gives an event type its id; a new type gets a new id where the vocabulary may grow.
using EventIds = std::function<core::EventId(const core::EventType&)>;

/// Turns the messages of one connection into event ids.
class ConnectionEncoder {
 public:
  /// Whether the next message is an event. The first one on a latching connection is not: it came
  /// because this program subscribed, not because it was published now. But of `rostopic pub`,
  /// which latches, it is: there may be no other. Call it once for every message.
  bool accept();
  /// Whether messages must be read; if not, all on this connection have one id.
  bool needsContent() const { return field_ != nullptr; }
  /// Id of a message if needsContent() is false.
  core::EventId id();
  /// Id of a message by its serialized content.
  /// @throw std::out_of_range if the message is shorter than its definition
  core::EventId id(const std::uint8_t* data, std::size_t size);

 private:
  friend class Encoder;

  EventIds ids_;
  core::EventType type_;
  std::optional<core::EventId> id_;  // given at the first message, not at the connection
  bool skip_next_ = false;
  std::shared_ptr<const MessageField> field_;
  std::string field_name_;
  std::unordered_map<std::string, core::EventId> ids_by_value_;
};

/// Encodes the messages of all connections of one system.
class Encoder {
 public:
  /// @throw std::invalid_argument names the pattern that is no regular expression
  Encoder(const EncodingRules& rules, EventIds ids);

  /// Whether the rules let any message of the topic be an event.
  bool includesTopic(const std::string& topic) const;
  /// Whether the rules let any message of the source be an event.
  /// @param source the publisher's stable name
  bool includesSource(const std::string& source) const;
  /// Encoder of the connection's messages; none if the rules leave them out.
  /// @throw std::invalid_argument if a type field does not fit the message's definition
  std::optional<ConnectionEncoder> connect(const Connection& connection) const;

 private:
  EncodingRules rules_;
  EventIds ids_;
  std::vector<std::regex> include_topics_;
  std::vector<std::regex> exclude_topics_;
  std::vector<std::regex> include_sources_;
  std::vector<std::regex> exclude_sources_;
};

}  // namespace self_awareness::ros1
