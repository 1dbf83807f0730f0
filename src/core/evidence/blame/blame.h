#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/evidence/blame/followers.h"
#include "core/evidence/blame/upstream.h"
#include "core/evidence/channel/scorer.h"
#include "self_awareness/core/stream/windows.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::evidence {

/// Names the event types that may have caused abnormal evidence (docs/method.md, section 6).
/// Silent ones come first, then those that are late or otherwise unusual. Of each kind, who is
/// upstream of others, or followed by them as usual, comes before them; then the least probable
/// silence, or who most of what is unusual involves. Nobody is named whose numbers are usual.
class Blame {
 public:
  /// @param upstream may be empty: only what usually follows what then says who is the root
  Blame(std::shared_ptr<const Model> model, std::shared_ptr<const Upstream> upstream);

  /// @param shares of their limits that the tracks of the model have reached
  /// @param events of the scorer's recording
  /// @param window that the scorer closed last
  /// @return at most kMostSuspects, the most likely first, each event type once; after them, of
  /// each further component whose evidence alone is abnormal the most likely event type
  std::vector<Suspect> suspects(const std::vector<double>& shares, const Scorer& scorer,
                                const RecentEvents& events, const Window& window) const;

 private:
  struct Candidate {
    std::size_t track = 0;  // that speaks against its `to`
    double rank = 0;        // the smaller, the more likely
    bool own = false;       // something is wrong with it, whatever the others do
    bool abnormal = false;  // that alone is beyond a limit
  };

  static bool likelier(const Candidate& a, const Candidate& b) { return a.rank < b.rank; }
  std::vector<Candidate> rootFirst(std::vector<Candidate> candidates,
                                   const Followers::Leads& leads) const;
  std::vector<Candidate> silent(const std::vector<double>& shares, const Scorer& scorer,
                                const RecentEvents& events, const Followers::Leads& leads) const;
  std::vector<Candidate> unusual(const std::vector<double>& shares, const Scorer& scorer,
                                 const RecentEvents& events, const Followers::Leads& leads) const;
  /// Moves to the front of `others` those whose followers are silent, although these owe them
  /// nothing: at half the rate of what they follow, say.
  /// @return the end of these
  std::vector<Candidate>::iterator rootsOfSilence(const std::vector<Candidate>& silent,
                                                  std::vector<Candidate>& others,
                                                  const Scorer& scorer, const RecentEvents& events,
                                                  const Followers::Leads& leads) const;
  /// Whether no more messages of the leader came since the follower's last one than usually do
  /// between two of the follower's; the last of them has half a mean gap to be answered.
  bool owesNothing(EventId follower, EventId leader, const Scorer& scorer,
                   const RecentEvents& events) const;
  /// Whether the age of what a track of silence watches is within its limit, and not rare.
  bool isUsualAge(std::size_t track, const std::vector<double>& shares,
                  const Scorer& scorer) const;
  double logSurvival(EventId id, const Scorer& scorer) const;
  std::size_t trackOfSilence(EventId id, const std::vector<double>& shares, const Scorer& scorer,
                             const RecentEvents& events) const;
  /// Whether what is said of a suspect is what it usually does.
  bool isUsual(const Suspect& suspect) const;
  EventId toOf(const Candidate& candidate) const { return model_->tracks()[candidate.track].to; }
  /// The number of its component.
  std::size_t componentOf(const Candidate& candidate) const {
    return model_->componentIndex(toOf(candidate));
  }

  std::shared_ptr<const Model> model_;
  std::shared_ptr<const Upstream> upstream_;
  Followers followers_;
  const Tuning& tuning_;
  double rare_silence_;  // log of its probability
};

}  // namespace self_awareness::core::evidence
