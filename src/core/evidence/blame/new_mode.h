#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/evidence/blame/upstream.h"
#include "core/evidence/channel/scorer.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/verdict/acceptance.h"
#include "self_awareness/core/verdict/silent.h"

namespace self_awareness::core::evidence {

/// Notices that components which do not hear each other stop at one moment, while others go on:
/// the robot is in a mode that training never saw, and nobody is to blame (docs/method.md, section
/// 6). Who depends on whom must be known: the victims of one that died stop at one moment, too.
class NewMode {
 public:
  NewMode(std::shared_ptr<const Model> model, std::shared_ptr<const Upstream> upstream);

  /// Takes back the evidence against who stopped in that way, and against who hears them.
  /// @param shares of their limits that the tracks of the model have reached
  /// @param limits of the model's tracks
  /// @param scorer that has closed the window
  /// @param may_be_silent event types of the model whose silence says nothing, by id
  /// @return who stopped; none: nobody has in that way, or that is accepted
  std::optional<Silent> excuse(std::vector<double>& shares, const Limits& limits,
                               const Scorer& scorer, const std::vector<bool>& may_be_silent);
  /// The same, if all who stopped are of one mode that is accepted, or it begins: that is normal.
  /// @return their components, in order; empty: they are not, or nobody has stopped
  std::vector<std::string> excuseAccepted(std::vector<double>& shares, const Limits& limits,
                                          const Scorer& scorer,
                                          const std::vector<bool>& may_be_silent);
  /// Takes the modes that are accepted, in place of those of before.
  void accept(const Acceptances& accepted);
  void restart();

 private:
  /// Who of the silent ones stopped in that way, or did so and is not back yet; empty: nobody.
  std::set<EventId> find(const std::vector<EventId>& silent, const std::vector<double>& shares,
                         const Heard& heard);
  /// Who of an accepted mode is silent since none of it was heard: it has begun, though it is too
  /// early to miss all of them. Who died alone is not off: the others were heard since.
  std::set<EventId> offIn(const Acceptance& mode, const std::vector<EventId>& silent,
                          const Heard& heard) const;
  /// Takes back the evidence against them, and against who hears them, did not fall silent before
  /// them, and was not heard later than `until` [ns]: who goes on does not wait for them.
  void takeBack(const std::set<EventId>& stopped, std::vector<double>& shares, const Heard& heard,
                std::int64_t until) const;
  /// The names of their components, in order.
  std::vector<std::string> namesOf(const std::set<EventId>& ids) const;
  /// Event types that should have come by now. Who owes an answer is none: that is its fault.
  std::vector<EventId> silent(const std::vector<double>& shares, const Limits& limits,
                              const Heard& heard, const std::vector<bool>& may_be_silent) const;
  /// Those of them that stopped as in a new mode, while one was beyond its limit.
  std::set<EventId> stopped(const std::vector<EventId>& silent, const std::vector<double>& shares,
                            const Heard& heard);
  /// Those of them that stopped when this one did.
  std::vector<EventId> stoppedWith(EventId id, const std::vector<EventId>& silent,
                                   const Heard& heard) const;
  /// Whether they are of enough components that are victims of nobody.
  bool areUnrelated(const std::vector<EventId>& ids, const Heard& heard) const;
  /// By component, whether it may have died by then [ns], judged or not: it was not heard since,
  /// but as lately as is usual.
  std::vector<bool> mayHaveDied(std::int64_t by, const Heard& heard) const;
  /// Whether somebody was heard for most of the time since then: or all are silent.
  bool othersGoOn(const std::vector<EventId>& stopped, const Heard& heard) const;
  /// Their components, each once.
  std::set<std::size_t> componentsOf(const std::vector<EventId>& ids) const;

  std::shared_ptr<const Model> model_;
  std::shared_ptr<const Upstream> upstream_;
  std::vector<std::int64_t> excused_until_;  // [ns], by id
  Acceptances accepted_;                     // modes alone
};

}  // namespace self_awareness::core::evidence
