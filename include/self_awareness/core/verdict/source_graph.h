#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>

namespace self_awareness::core {

/// Says whose messages reach whom (docs/method.md, section 6): it has an edge from every source
/// that publishes on a topic to every source that subscribes to it.
class SourceGraph {
 public:
  void connect(const std::string& from, const std::string& to) { followers_[from].insert(to); }

  bool empty() const { return followers_.empty(); }
  const std::map<std::string, std::set<std::string>>& edges() const { return followers_; }
  /// Whether `to` subscribes to what `from` publishes.
  bool isConnected(const std::string& from, const std::string& to) const;
  /// Whether messages of `from` reach `to`, directly or through others, in fewer steps than the
  /// other way round. Robots have loops; what is wrong with both more likely began at `from`.
  bool isUpstream(const std::string& from, const std::string& to) const;

 private:
  /// Number of steps from a source to another or back to itself; none: there is no way.
  std::optional<std::size_t> distance(const std::string& from, const std::string& to) const;

  std::map<std::string, std::set<std::string>> followers_;
};

}  // namespace self_awareness::core
