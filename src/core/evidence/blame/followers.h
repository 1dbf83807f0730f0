#pragma once

#include <cstddef>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "core/evidence/channel/scorer.h"
#include "core/evidence/watch/recent_events.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::evidence {

/// Says which components follow which others, and do so as usual at present: what is wrong with
/// both of them began with the one that is followed (docs/method.md, section 6). It needs no
/// graph, only relations that are known from training.
class Followers {
 public:
  /// Pairs of components, by number, of which the second follows the first.
  using Leads = std::set<std::pair<std::size_t, std::size_t>>;

  explicit Followers(std::shared_ptr<const Model> model);

  /// Who follows whom as usual.
  /// @param shares of their limits that the tracks of the model have reached
  Leads leads(const std::vector<double>& shares) const;
  /// Where an event type comes late after another, and follows a third one as usual, the third one
  /// is late, too, even if its delays are not judged.
  /// @param late tracks of event types that come late
  /// @return tracks of the third ones: how late they come after the same event types
  std::vector<std::size_t> lateBefore(const std::vector<std::size_t>& late,
                                      const std::vector<double>& shares, const Scorer& scorer,
                                      const RecentEvents& events) const;

 private:
  bool follows(const Track& track) const;

  std::shared_ptr<const Model> model_;
  std::vector<bool> follows_;  // whether `to` usually comes soon after `from`, by track
};

/// The event type that a track watches as a suspect, with the reason.
Suspect suspectOf(std::size_t track, const Scorer& scorer, const RecentEvents& events);

}  // namespace self_awareness::core::evidence
