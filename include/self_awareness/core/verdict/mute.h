#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/verdict/alarm.h"
#include "self_awareness/core/verdict/source_graph.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core {

/// What somebody does not want to be told for a while (docs/live.md). It is judged as before.
struct Mute {
  std::string component;         ///< a name, or its begin and a `*`; empty: all
  std::string topic;             ///< likewise
  std::optional<Kind> kind;      ///< none: all
  std::int64_t until = 0;        ///< it ends then at the latest [ns]
  bool until_over = false;       ///< it ends when all is normal again after it muted something
  std::string by;                ///< who wanted it
  std::uint32_t alarms = 0;      ///< that it has muted
  std::uint32_t suspicions = 0;  ///< likewise
  bool has_muted = false;        ///< something since it was asked for, or what still stands

  /// Whether it mutes everything: maintenance.
  bool mutesAll() const { return component.empty() && topic.empty() && !kind; }
  /// Whether it is about the same as another one.
  bool isLike(const Mute& other) const {
    return component == other.component && topic == other.topic && kind == other.kind;
  }
};

/// Keeps mutes, and says whether what stands is muted. Each has an end.
///
/// Times are of one clock, of which it does not matter which [ns].
class Mutes {
 public:
  /// Mutes at a time, at most so many.
  static constexpr std::size_t kMost = 100;

  /// Adds a mute, or renews the one that is like it: what that has muted counts on. Where somebody
  /// else wanted it for longer, it stays as he wanted it.
  /// @return the mute that there is now, until the next call; null: there is no room for it
  const Mute* add(const Mute& mute);
  /// Takes a mute back. @return it; none: there is none like it
  std::optional<Mute> end(const Mute& like);
  /// Ends those whose time has come. @return them
  std::vector<Mute> advance(std::int64_t now);

  /// Takes in what stands now, whenever that has changed, or the mutes have.
  ///
  /// It is muted if its culprit is, and whoever else is abnormal of itself and does not depend on
  /// the culprit. Where there is no culprit, its kind counts.
  /// @param standing none: nothing stands
  /// @param vocabulary that its suspects' ids are of
  /// @param graph whose messages reach whom
  /// @return those that end with what they muted
  std::vector<Mute> onStanding(const std::optional<Alarm>& standing, const Vocabulary& vocabulary,
                               const SourceGraph& graph);
  /// The mute of what stands; null: it is not muted, or nothing stands.
  const Mute* active() const;
  /// The mute of all that can be said of a component, whatever its topic and kind; null: there is
  /// none. What was started again is such a thing.
  const Mute* ofComponent(const std::string& component) const;

  const std::vector<Mute>& list() const { return mutes_; }

 private:
  /// Index of the mute of a suspect; none: it is not muted.
  std::optional<std::size_t> muteOf(const std::string& component, const std::string& topic,
                                    Kind kind) const;
  std::optional<std::size_t> muteOf(const Suspect& suspect, const Vocabulary& vocabulary) const;
  /// Index of the mute of an alarm; none: it is not muted.
  std::optional<std::size_t> muteOf(const Alarm& alarm, const Vocabulary& vocabulary,
                                    const SourceGraph& graph) const;
  /// Whether nobody of them has to be told beside the culprit: who is abnormal by itself depends
  /// on it, or is muted; or there is no culprit.
  bool areMuted(const std::vector<Suspect>& suspects, const Alarm& alarm,
                const Vocabulary& vocabulary, const SourceGraph& graph) const;

  std::vector<Mute> mutes_;
  std::optional<std::size_t> active_;
  std::string culprit_;        // of what stood last
  std::uint64_t counted_ = 0;  // id of the last alarm or suspicion that was counted
};

}  // namespace self_awareness::core
