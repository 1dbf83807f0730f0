#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "part.h"
#include "self_awareness/ros/encoding.h"

namespace self_awareness {

/// Follows nodes that are started again, by roslaunch's respawn or by hand: the same name comes
/// with another address. What is asked and said of them is by the names that events have: the
/// model of a fleet renames nodes.
///
/// Times are ROS time [ns].
class Restarts {
 public:
  /// So many restarts within kSpan are a fault, and no excuse for what is unusual after the next.
  static constexpr std::size_t kMany = 3;
  static constexpr std::int64_t kSpan = 600'000'000'000;
  /// Nodes that are followed, at most so many: the first.
  static constexpr std::size_t kMostNodes = 5000;

  /// @param settle_time so long after it is heard again, a node may be judged
  explicit Restarts(std::int64_t settle_time) : settle_time_(settle_time) {}

  /// Takes in where nodes are.
  /// @param addresses URIs, by the full names of nodes
  /// @param encoder gives them the names that events have, and says who is left out
  /// @param when in words
  /// @return sources that were started again
  std::vector<std::string> see(const std::map<std::string, std::string>& addresses,
                               const ros1::Encoder& encoder, std::int64_t now,
                               const std::string& when);
  /// A source that was started again is heard.
  void onHeard(const std::string& source, std::int64_t now);
  /// Time has passed.
  /// @param abnormal who is named by what stands
  /// @return lines for those that are back as usual
  std::vector<std::string> advance(std::int64_t now, const std::set<std::string>& abnormal);
  /// ROS time was set.
  void onClockSet();

  /// How often a source was started again in the last kSpan.
  std::size_t count(const std::string& source, std::int64_t now) const;
  /// That in words: "restarted 7 times in 10 min"; empty: it was not.
  std::string inWords(const std::string& source, std::int64_t now) const;

 private:
  struct Source {
    std::deque<std::int64_t> restarts;  // of the last kSpan, the newest kMostCounted
    std::string when;                   // the last one was, in words
    bool waits = false;                 // for it to be as usual
    std::optional<std::int64_t> heard;  // first, since the last one
  };

  std::int64_t settle_time_;
  std::map<std::string, std::string> addresses_;  // by the full names of nodes
  std::map<std::string, Source> sources_;         // those that were started again
};

/// Excuses a node that was started again until it is as usual, and says so; who is started again
/// and again is a near miss, and no more excused.
class RestartWatch : public Part {
 public:
  explicit RestartWatch(Host& host);

  /// The first event of a type has come since its node was started again, and is judged next.
  void onFirst(const core::Event& event);
  void onGraph(const ros1::Graph& graph) override;
  void onTick(const Moment& now) override;
  void onCut(Cut why) override;
  void onReport(MonitorState& state) override;

 private:
  void onRestarted(const std::string& source, core::Alarm near_miss);

  Host& host_;
  Restarts restarts_;
};

}  // namespace self_awareness
