#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/verdict/acceptance.h"
#include "self_awareness/core/verdict/source_graph.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::evidence {

/// Notices components that run, and do not subscribe to what they did in every start of the
/// training (docs/robots.md). A start takes its time, and so does a restart: what is missing
/// for no longer than that is normal.
class Unsubscribed {
 public:
  explicit Unsubscribed(const Model& model);

  /// Takes note of all that is missing from now on.
  void set(const std::set<SourceGraph::Subscription>& missing);
  /// Takes what is accepted, in place of what was before: it is not missing.
  void accept(const Acceptances& accepted);
  /// All that is missing is so from the next window on only.
  void restart();
  /// Looks at how long it has been missing.
  /// @param end of the window [ns]
  void closeWindow(std::int64_t end);
  /// Whether something is missing for too long.
  bool any() const { return !suspects_.empty(); }
  /// Who misses it, in the order of their names.
  const std::vector<Suspect>& suspects() const { return suspects_; }

 private:
  struct Missing {
    std::optional<std::int64_t> since;  // [ns]; none: the next window says it
    bool accepted = false;
  };

  /// Looks at what of it is accepted.
  void update();
  Suspect suspect(const std::string& component, const std::vector<std::string>& topics) const;

  std::int64_t start_time_;             // that a start may take [ns]
  std::size_t starts_;                  // of the training
  std::map<std::string, EventId> ids_;  // of one event type of each component
  Acceptances accepted_;
  std::map<SourceGraph::Subscription, Missing> missing_;
  std::size_t late_ = 0;  // of these, missing for too long
  std::vector<Suspect> suspects_;
};

}  // namespace self_awareness::core::evidence
