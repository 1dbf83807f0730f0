#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "core/evidence/watch/heard.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/verdict/source_graph.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::evidence {

/// Tells of components whose topics come from two senders of one name: another process, or another
/// robot, has their names (docs/method.md, section 6). What is unusual of them meanwhile is that.
class TwoSenders {
 public:
  explicit TwoSenders(std::shared_ptr<const Model> model);

  /// Takes note of all that comes from two senders from now on. What did in training, too, as the
  /// numbers of its messages tell, is normal.
  void set(const std::set<SourceGraph::Publication>& doubled);
  /// All of it is new with the next window.
  void restart() { since_.reset(); }
  /// Looks at how long there have been any, at the end of a window.
  void closeWindow(const Heard& heard);
  /// Whether there are any.
  bool any() const { return !doubled_.empty(); }
  /// Whether there have been some for longer than a restart takes.
  bool last() const { return lasting_; }
  /// All event types of the components that they are of.
  const std::vector<EventId>& types() const { return types_; }
  /// One for each of these components.
  std::vector<Suspect> suspects(const Heard& heard) const;

 private:
  std::shared_ptr<const Model> model_;
  std::map<SourceGraph::Publication, std::vector<EventId>> ids_;  // of the model
  std::set<SourceGraph::Publication> doubled_;
  std::vector<EventId> types_;
  std::optional<std::int64_t> since_;  // [ns]; none: the next window says it
  bool lasting_ = false;
};

}  // namespace self_awareness::core::evidence
