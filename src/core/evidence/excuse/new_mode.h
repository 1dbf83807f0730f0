#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/evidence/excuse/excuse.h"

namespace self_awareness::core::evidence {

/// The excuse that some that do not hear each other stopped at one moment, while others go on: the
/// robot is in a mode that training never saw, or that somebody has accepted (docs/method.md,
/// section 6.1). It must be known who hears whom: the victims of one that died stop at one moment,
/// too.
class NewMode : public Excuse {
 public:
  explicit NewMode(std::shared_ptr<const Model> model)
      : model_(std::move(model)), excused_until_(model_->size(), 0) {}

  Excused reason() const override { return is_accepted_ ? Excused::kAccepted : Excused::kNewMode; }
  std::optional<std::int64_t> closeWindow(const Unusual& window, Judgement& judgement) override;
  /// Those that stopped, and who hears one of them, was not missed before that one stopped, and
  /// was not heard long after: who goes on does not wait for them.
  bool explains(const Excess& excess, const Unusual& window) const override;
  void accept(const Acceptances& accepted) override;
  void restart() override;

 private:
  using Ids = std::vector<EventId>;

  std::set<std::size_t> componentsOf(const Ids& ids) const;
  /// The names of components, in order.
  std::vector<std::string> namesOf(const Ids& ids) const;

  /// Event types that should have come by now. Who owes an answer is none: that is its fault.
  Ids silent(const Unusual& window) const;
  /// Those of the silent ones that stopped as in a new mode, or did so and are not back yet.
  std::set<EventId> stopped(const Ids& silent, const Unusual& window);
  /// Those of them that stopped when this one did: none was missed when the other one came last.
  Ids stoppedWith(EventId id, const Ids& silent, const Unusual& window) const;
  /// When, by id, it was first told of its component since its last event that something of it
  /// does not come, or by who waits for it [ns]; kNotYet: it was not.
  std::vector<std::int64_t> missedBy(const Unusual& window) const;
  /// Whether who was not heard since was beyond its limit at a stamp [ns], or missed by then.
  bool wasMissed(EventId id, std::int64_t stamp, const Unusual& window) const;
  /// What stopped together, for each that is beyond its limit; most at once come first.
  std::vector<Ids> groups(const Ids& silent, const Unusual& window) const;
  /// Whether they are of enough components that are victims of nobody.
  bool areUnrelated(const Ids& ids, const Unusual& window) const;
  /// Whether somebody was heard for most of the time since they were: or all are silent.
  bool othersGoOn(const Ids& ids, const Heard& heard) const;
  /// Who of an accepted mode is silent since none of it was heard: it has begun, though it is too
  /// early to miss all of them. Who died alone is not off: the others were heard since.
  void addOff(const Acceptance& mode, const Ids& silent, const Heard& heard,
              std::set<EventId>& off) const;

  std::shared_ptr<const Model> model_;
  Acceptances accepted_;                     // modes alone
  std::vector<std::int64_t> excused_until_;  // [ns], by id
  // Of the last window:
  std::vector<std::int64_t> missed_;  // missedBy()
  bool is_accepted_ = false;
  Ids stopped_;                                     // in order
  std::int64_t since_ = 0;                          // the last event of those [ns]
  std::map<std::size_t, std::int64_t> stopped_at_;  // last events of their components [ns]
};

}  // namespace self_awareness::core::evidence
