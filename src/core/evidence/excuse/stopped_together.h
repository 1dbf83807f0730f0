#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/evidence/explain/excess.h"
#include "core/evidence/watch/upstream.h"
#include "self_awareness/core/verdict/acceptance.h"
#include "self_awareness/core/verdict/silent.h"
#include "self_awareness/core/verdict/source_graph.h"

namespace self_awareness::core::evidence {

/// The excuse that many stopped at one moment (docs/method.md, section 6): all, or all that run on
/// one computer while others are heard, so that it is what they share; or some that do not hear
/// each other, while others go on: the robot is in a mode that training never saw, or that
/// somebody has accepted. For the last, it must be known who hears whom: the victims of one that
/// died stop at one moment, too.
class StoppedTogether {
 public:
  /// @param graph that says on which computers sources run; may grow
  StoppedTogether(std::shared_ptr<const Model> model, std::shared_ptr<const Upstream> upstream,
                  std::shared_ptr<const SourceGraph> graph);

  /// What it says of a window.
  struct Found {
    std::optional<Silent> silent;   ///< who stopped
    std::vector<std::string> mode;  ///< or components of an accepted mode, in order
  };
  /// Excuses who stopped together, and who does not come because of that.
  /// @param excesses all that is unusual in the window that the scorer closed last
  /// @param limits of the model's tracks
  /// @param strangers time since sources sent what the model does not know [ns]
  /// @param may_be_silent event types of the model whose silence says nothing, by id
  Found excuse(std::vector<Excess>& excesses, const Limits& limits, const Scorer& scorer,
               const std::map<std::string, std::int64_t>& strangers,
               const std::vector<bool>& may_be_silent);
  /// Takes the modes that are accepted, in place of those of before.
  void accept(const Acceptances& accepted);
  void restart();

 private:
  using Ids = std::vector<EventId>;

  struct Component {
    bool seen = false;
    std::int64_t silence = 0;  // since its last event of any type [ns], once it was seen
    bool judged = false;
    bool silent = false;       // it should have spoken by now
    bool near = false;         // nearly for longer than it is allowed to
    std::int64_t longest = 0;  // gap that is usual of what it says most often [ns], once judged
  };
  /// Components with something in common: all, or those on one computer.
  struct Group {
    std::int64_t silence = std::numeric_limits<std::int64_t>::max();  // of all of them [ns]
    std::vector<std::size_t> judged;                                  // their indices

    void add(std::size_t index, const Component& component);
  };
  struct Window {
    std::vector<double> limits;  // of silence, by id; NaN: it is not judged
    const Heard& heard;
    std::vector<Excess>& excesses;
    std::vector<std::int64_t> missed;  // missedBy(), by id; empty without a graph
  };

  std::vector<double> limitsOfSilence(const Limits& limits) const;
  const Track& trackOf(const Excess& excess) const { return model_->tracks()[excess.track]; }
  /// Whether an event type has been silent for longer than is usual.
  bool isRare(EventId id, std::int64_t silence) const;
  std::set<std::size_t> componentsOf(const Ids& ids) const;
  /// The names of components, in order.
  std::vector<std::string> namesOf(const std::set<std::size_t>& components) const;

  std::optional<Silent> everything(const Window& window,
                                   const std::map<std::string, std::int64_t>& strangers) const;
  std::vector<Component> look(const Window& window) const;
  /// Those of a group that fell silent together; empty: somebody is heard, or too few are near
  /// their limits. Who fell silent before is none of them, and does not speak against it.
  std::vector<std::size_t> together(const Group& group,
                                    const std::vector<Component>& components) const;

  /// Event types that should have come by now. Who owes an answer is none: that is its fault.
  Ids silent(const Window& window, const std::vector<bool>& may_be_silent) const;
  /// Those of the silent ones that stopped as in a new mode, or did so and are not back yet.
  std::set<EventId> stopped(const Ids& silent, const Window& window);
  /// Those of them that stopped when this one did: none was missed when the other one came last.
  Ids stoppedWith(EventId id, const Ids& silent, const Window& window) const;
  /// When, by id, it was first told of its component since its last event that something of it
  /// does not come, or by who waits for it [ns]; kNotYet: it was not.
  std::vector<std::int64_t> missedBy(const Heard& heard,
                                     const std::vector<Excess>& excesses) const;
  /// Whether who was not heard since was beyond its limit at a stamp [ns], or missed by then.
  bool wasMissed(EventId id, std::int64_t stamp, const Window& window) const;
  /// What stopped together, for each that is beyond its limit; most at once come first.
  std::vector<Ids> groups(const Ids& silent, const Window& window) const;
  /// Whether they are of enough components that are victims of nobody.
  bool areUnrelated(const Ids& ids, const Heard& heard) const;
  /// Whether somebody was heard for most of the time since they were: or all are silent.
  bool othersGoOn(const Ids& ids, const Heard& heard) const;
  /// Who of an accepted mode is silent since none of it was heard: it has begun, though it is too
  /// early to miss all of them. Who died alone is not off: the others were heard since.
  void addOff(const Acceptance& mode, const Ids& silent, const Heard& heard,
              std::set<EventId>& off) const;
  /// Excuses them, and who hears one of them, was not missed before that one stopped, and was not
  /// heard later than `until` [ns]: who goes on does not wait for them.
  void cover(const Ids& stopped, Excuse excuse, std::int64_t until, const Window& window) const;

  std::shared_ptr<const Model> model_;
  std::shared_ptr<const Upstream> upstream_;
  std::shared_ptr<const SourceGraph> graph_;
  std::vector<std::int64_t> excused_until_;  // [ns], by id
  Acceptances accepted_;                     // modes alone
};

}  // namespace self_awareness::core::evidence
