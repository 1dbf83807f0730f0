#pragma once

#include <ros/datatypes.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/stream/vocabulary.h"

namespace self_awareness::ros1 {

/// A rule by which names of nodes (without anonymous numbers) and topics are replaced.
struct Rename {
  std::string pattern;
  std::string name;  ///< \1 to \9 stand for what the groups of the pattern match

  friend bool operator==(const Rename& a, const Rename& b) {
    return a.pattern == b.pattern && a.name == b.name;
  }
};

/// Classes that the values of a numeric type field are put into (docs/monitor.md). A value that
/// is no number has one of its own.
struct ValueClasses {
  static constexpr std::size_t kFewest = 2;
  static constexpr std::size_t kMost = 16;

  std::size_t number = kFewest;  ///< that are wanted; there are fewer where values are the same
  std::vector<double> bounds;    ///< that a class begins with, ascending; empty: not learned yet

  friend bool operator==(const ValueClasses& a, const ValueClasses& b) {
    return a.number == b.number && a.bounds == b.bounds;
  }
};

/// Classes in words: "below 0.5", "0.5 to 2.1", "2.1 or more" and "NaN".
std::vector<std::string> namesOfClasses(const std::vector<double>& bounds);
/// The class of a value, by its place among them.
std::size_t classOf(double value, const std::vector<double>& bounds);

/// What tells the mode that the robot is in (docs/robots.md): a field of the messages on a topic.
struct ModeField {
  std::string topic;  ///< as the renames leave it
  std::string field;  ///< an integer, a bool or a string, not in an array; nested ones with dots

  friend bool operator==(const ModeField& a, const ModeField& b) {
    return a.topic == b.topic && a.field == b.field;
  }
};

/// How messages become events: the rules of the function f (paper, section IV-C; docs/method.md,
/// section 1.1). The model holds them, so training and the monitor cannot disagree. Patterns are
/// regular expressions of RE2 (github.com/google/re2/wiki/Syntax) that must match the whole name.
struct EncodingRules {
  enum class Source {
    kCallerId,  ///< the publisher's node name, without anonymous numbers
    kNone       ///< left out: replays by rosbag play, bags without callerids
  };

  Source source = Source::kCallerId;
  std::vector<Rename> renames;  ///< the first that matches counts; all that follows sees new names
  std::vector<std::string> include_topics;  ///< empty: all
  std::vector<std::string> exclude_topics;
  std::vector<std::string> include_sources;  ///< empty: all; no effect for Source::kNone
  std::vector<std::string> exclude_sources;
  /// Field by the datatype of messages, or of one of their own fields. One that lies in an array
  /// says what the messages list.
  std::map<std::string, std::string> type_fields;
  std::map<std::string, ValueClasses> classes;  ///< of some type fields, by datatype
  std::optional<ModeField> mode;                ///< none: nobody tells a mode

  /// Rules that suit most robots: everything but the monitor's own output, clocks, aggregated
  /// logs, bonds and tools that only look on.
  static EncodingRules defaults();
  /// @throw std::invalid_argument names the pattern that is no regular expression, the new name
  /// that does not fit one, what has control characters, classes that cannot be, or the topic of
  /// the mode that is none or is left out; or the patterns are too large together
  void validate() const;
};

bool operator==(const EncodingRules& a, const EncodingRules& b);

/// Most event types that one type field, or the field of the mode, may make. Every pair of event
/// types has a histogram: a field with many values, such as an identifier, would fill the memory
/// and teach nothing.
constexpr std::size_t kMostTypesOfField = 1000;

/// Most event types of one robot: what is counted grows with their square, to some GB here.
constexpr std::size_t kMostEventTypes = 4000;

/// Checks that there are not too many event types to learn them.
/// @throw std::invalid_argument names the type field that makes more than kMostTypesOfField, or
/// says that all together are more than kMostEventTypes
void checkEventTypes(const EncodingRules& rules, const core::Vocabulary& vocabulary);

/// Id of an event type in a vocabulary that may grow up to `most`, and by one more: what is new
/// then has the type "(further unknown events)" all together. Who makes up new names or values all
/// the time must not fill the memory.
core::EventId internUpTo(std::size_t most, const core::EventType& type,
                         core::Vocabulary& vocabulary);

/// One publisher's connection to a topic, from a connection header, live or in a bag.
struct Connection {
  std::string callerid;
  std::string topic;
  std::string datatype;
  std::string definition{};
  bool latching = false;
  std::string md5sum{};  ///< of the definition
};

/// Longest name of a topic, of a node, or of a type [bytes]. Longer ones are made up.
constexpr std::size_t kLongestName = 1000;

/// Why no message of a connection can be an event, whatever the rules: its topic has a name that
/// roscpp refuses to subscribe to, or a name is too long. Empty: it can.
std::string whyLeftOut(const Connection& connection);
/// The same, as far as the name of the topic says it.
std::string whyLeftOut(const std::string& topic);

/// What a connection header says, in UTF-8: what is none is replaced. Names are whole, as ROS
/// resolves them (resolvedName()). Fields that it lacks are empty.
/// @param topic as the recorder, or the master, calls it
Connection connectionFrom(const ros::M_string& header, const std::string& topic);

/// Gives an event type its id; a new type gets a new id where the vocabulary may grow.
using EventIds = std::function<core::EventId(const core::EventType&)>;

class ListedField;
class MessageField;
class NamePatterns;
class NameRenames;

/// Turns the messages of one connection into event ids.
class ConnectionEncoder {
 public:
  /// Whether the next message is an event. The first one on a latching connection is not: it came
  /// because this program subscribed, not because it was published now. But of `rostopic pub`,
  /// which latches, it is: there may be no other. Call it once for every message.
  bool accept();
  /// Whether messages must be read; if not, all on this connection have one id.
  bool needsContent() const {
    return field_ != nullptr || listed_field_ != nullptr || tellsMode();
  }
  /// Id of the event that says that a message is held ready, in place of one that accept() does
  /// not take (core::isLatched()); none: of lines for people, that says nothing.
  std::optional<core::EventId> latched();
  /// Id of a message if needsContent() is false.
  core::EventId id();
  /// Id of a message by its serialized content.
  /// @throw std::out_of_range if the message is shorter than its definition
  core::EventId id(const std::uint8_t* data, std::size_t size);
  /// Whether each message tells the robot's mode, which is an event besides (core/stream/mode.h);
  /// also one that accept() does not take: what was latched is what lasts.
  bool tellsMode() const { return mode_field_ != nullptr; }
  /// Id of that event by the message's content.
  /// @throw std::out_of_range if the message is shorter than its definition
  core::EventId mode(const std::uint8_t* data, std::size_t size);
  /// Id of the event that says what the messages list, besides them (core/stream/listed.h): where
  /// that has changed, and once a second; none: there is nothing to tell.
  /// @param stamp of the message [ns]
  /// @throw std::out_of_range if the message is shorter than its definition
  std::optional<core::EventId> list(const std::uint8_t* data, std::size_t size,
                                    std::int64_t stamp);

 private:
  friend class Encoder;
  using Known = std::unordered_map<std::string, core::EventId>;  // by value

  /// @param typeOf the type that a value makes
  template <typename TypeOf>
  core::EventId idByValue(const std::string& value, Known& known, const TypeOf& typeOf);

  EventIds ids_;
  core::EventType type_;
  std::optional<core::EventId> id_;  // given at the first message, not at the connection
  bool skip_next_ = false;
  std::shared_ptr<const MessageField> field_;
  std::string field_name_;
  std::vector<double> bounds_;  // of the classes of its values; empty: each is one
  std::vector<std::string> class_names_;
  Known ids_by_value_;
  std::shared_ptr<const MessageField> mode_field_;
  Known ids_by_mode_;
  std::shared_ptr<ListedField> listed_field_;
  std::shared_ptr<const NameRenames> renames_;  // of what is listed
};

/// Encodes the messages of all connections of one system.
class Encoder {
 public:
  /// @throw std::invalid_argument names the pattern that is no regular expression
  Encoder(const EncodingRules& rules, EventIds ids);

  /// Whether sources are told apart.
  bool tellsSources() const { return rules_.source == EncodingRules::Source::kCallerId; }
  /// What events call a node: by its whole name, without anonymous numbers, and renamed.
  /// @param node its name, whole, stable or as somebody wrote it
  std::string sourceOf(const std::string& node) const;
  /// What events call a topic: by its whole name (resolvedName()), renamed.
  std::string scopeOf(const std::string& topic) const;
  /// An event type of a recording that nothing was renamed in; none if the rules leave it out.
  std::optional<core::EventType> renamed(const core::EventType& type) const;
  /// Whether any message of the topic can be an event: by the rules, and by its name (whyLeftOut).
  bool includesTopic(const std::string& topic) const;
  /// Whether the rules let any message of the source be an event.
  /// @param source the publisher's stable name
  bool includesSource(const std::string& source) const;
  /// What a player (`rosbag play`) that is no part of the robot plays on a connection: no event,
  /// but a type whose source is the player, by its full name; none: it is no player, or says it of
  /// itself.
  std::optional<core::EventType> played(const Connection& connection) const;
  /// Whether a node that subscribes to a topic uses it: tools of people who watch do not.
  /// @param source the subscriber's stable name
  bool listens(const std::string& source) const;
  /// Event type of the connection's messages, without the value of a field; none if the rules or
  /// their names leave them out, or if they are of a type of this package.
  std::optional<core::EventType> typeOf(const Connection& connection) const;
  /// Encoder of the connection's messages; none where typeOf() is none.
  /// @throw std::invalid_argument if a type field, or the field of the mode, does not fit the
  /// message's definition, or classes of its values are not learned yet
  std::optional<ConnectionEncoder> connect(const Connection& connection) const;

 private:
  EncodingRules rules_;
  EventIds ids_;
  std::shared_ptr<const NameRenames> renames_;
  std::shared_ptr<const NamePatterns> include_topics_;
  std::shared_ptr<const NamePatterns> exclude_topics_;
  std::shared_ptr<const NamePatterns> include_sources_;
  std::shared_ptr<const NamePatterns> exclude_sources_;
};

}  // namespace self_awareness::ros1
