#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "core/evidence/explain/unusual.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::evidence {

/// Says who is to blame for what is unusual (docs/method.md, section 6): who does not come before
/// who is unusual of itself, that before who comes late after another one. Of each of these, who
/// is upstream of others, or followed by them as usual, comes first.
class Explanation {
 public:
  explicit Explanation(std::shared_ptr<const Model> model)
      : model_(std::move(model)), tuning_(model_->tuning()) {}

  /// @return one suspect for each component with an excess that is not excused, the most likely
  /// first: at most kMostSuspects, and further ones whose evidence alone is abnormal. Nobody whose
  /// numbers are usual
  std::vector<Suspect> suspects(const Unusual& window) const;

 private:
  /// What is wrong with a component, the likeliest to be a cause first.
  enum class Wrong { kAbsent, kOwn, kLate, kOther };

  /// A component with something unusual.
  struct Accused {
    Wrong wrong = Wrong::kOther;
    std::size_t component = 0;
    const Excess* main = nullptr;  // what it is named for
    double sum = 0;                // of the shares that involve it
    bool abnormal = false;         // one of them is beyond its limit
    std::set<std::size_t> after;   // components after which it is late
    // Of who is absent: when it should have come, and when at the latest [ns]; whether it is
    // beyond its limit; and whether something else of it was heard since.
    std::int64_t due = std::numeric_limits<std::int64_t>::max();
    std::int64_t latest = 0;
    bool near = false;  // its limit
    bool sure = false;
    bool alive = false;
  };
  Suspect suspectOf(const Excess& excess, const Unusual& window) const;
  /// Whether it says that its type has not come, for longer than is usual.
  bool isAbsent(const Excess& excess, const Unusual& window) const;
  void accuse(const Excess& excess, const Unusual& window, std::vector<Accused>& accused) const;
  /// Who is absent, but not beyond its limit, is the root of who is to blame, or hardly is: then
  /// it is among the rest.
  void setUnlikelyAside(std::vector<Accused>& accused, const Unusual& window) const;
  /// So is who is late only after those that something else is wrong with.
  static void setExplainedAside(std::vector<Accused>& accused);
  /// Those with something wrong, ordered.
  std::vector<Accused> order(std::vector<Accused> accused, const Unusual& window) const;
  std::vector<Accused> rootFirst(const std::vector<Accused>& accused, const Unusual& window) const;
  bool isRoot(const Accused& root, const Accused& victim, const Causes& causes) const;
  /// Whether no more messages of the leader came since the follower's last one than usually do
  /// between two of the follower's; the last of them has half a mean gap to be answered.
  bool owesNothing(EventId follower, EventId leader, const Unusual& window) const;
  /// Whether what is said of a suspect is what it usually does.
  bool isUsual(const Suspect& suspect) const;

  std::shared_ptr<const Model> model_;
  const Tuning& tuning_;
};

}  // namespace self_awareness::core::evidence
