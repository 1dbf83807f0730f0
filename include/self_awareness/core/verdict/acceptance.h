#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core {

/// Whether a name is one that somebody has asked for.
/// @param pattern a name, or its begin and a `*`; empty: any
inline bool matchesPattern(const std::string& pattern, const std::string& name) {
  if (pattern.empty() || pattern.back() != '*') {
    return pattern.empty() || pattern == name;
  }
  return name.compare(0, pattern.size() - 1, pattern, 0, pattern.size() - 1) == 0;
}

/// What somebody takes as normal from now on (docs/live.md): it is no evidence any more.
struct Acceptance {
  /// How much of what it names is accepted. A fault seldom comes alone: who is slow is late, too.
  enum class Extent {
    kStranger,     ///< that it is there, although training never saw it
    kTime,         ///< when and how often it comes; that it falls silent is still judged
    kMessages,     ///< how old, complete, large and new its messages are
    kConnections,  ///< what it does not subscribe to
    kNothing,      ///< what no component does: as isShared() says, but for a mode
    kMode,         ///< that components are off together while others go on
    kAbsence,      ///< that it is absent; while it is there, it is judged
    kAll           ///< whatever it does
  };

  std::string component;     ///< a name, or its begin and a `*`; empty: all
  std::string topic;         ///< likewise; of kUnsubscribed, what it does not subscribe to
  std::optional<Kind> kind;  ///< none: all that it does
  /// Of kNewMode: the components that are off together, in order; then there is no name above.
  std::vector<std::string> together{};
  std::int64_t at = 0;  ///< when it was accepted [ns of ROS time]
  std::string by{};     ///< who did

  Extent extent() const;
  /// Whether it is about an event type: of a mode, whether its component may be off.
  bool isAbout(const std::string& of_component, const std::string& of_topic) const;
  /// Whether it is about the same as another one.
  bool isLike(const Acceptance& other) const {
    return component == other.component && topic == other.topic && kind == other.kind &&
           together == other.together;
  }
};

/// What is accepted: each is there once.
class Acceptances {
 public:
  /// At most so many.
  static constexpr std::size_t kMost = 1000;

  /// Adds one, or replaces the one that is like it.
  /// @return whether there is room for it
  bool add(const Acceptance& acceptance);
  /// Adds all of others, however many there are.
  void add(const Acceptances& others);
  /// Takes back all that fits: of a mode, one of its components has to.
  /// @param pattern its names are patterns; no kind: any. A mode: that of the same components
  /// @return what is taken back
  std::vector<Acceptance> remove(const Acceptance& pattern);

  /// Whether something that an event type does is accepted; of kUnsubscribed, that a component
  /// does not subscribe to a topic.
  bool covers(const std::string& component, const std::string& topic, Kind kind) const;
  /// Whether it is accepted that an event type is absent, and no more than that.
  bool mayBeAbsent(const std::string& component, const std::string& topic) const;
  /// Whether it is accepted that these are off together: all are of one mode.
  /// @param off names of components, in order
  bool coversMode(const std::vector<std::string>& off) const;
  const std::vector<Acceptance>& list() const { return list_; }

 private:
  std::vector<Acceptance> list_;
};

}  // namespace self_awareness::core
