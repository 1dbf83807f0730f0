#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/evidence/channel/scorer.h"
#include "core/evidence/excuse/accepted.h"
#include "core/evidence/presence/moved.h"
#include "core/evidence/presence/players.h"
#include "core/evidence/presence/strangers.h"
#include "core/evidence/presence/two_senders.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/stream/windows.h"
#include "self_awareness/core/verdict/senders.h"
#include "self_awareness/core/verdict/source_graph.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::evidence {

/// Knows who sends that did not in training (docs/robots.md): strangers, who has the place of
/// others, players, and who has the name of others.
class WhoSends {
 public:
  /// @param heard event types by id, those of the model first; may grow. None: nobody is known
  /// @param graph of the training
  /// @param expected event types of the model that come after every start, by id
  WhoSends(const std::shared_ptr<const Model>& model,
           const std::shared_ptr<const Vocabulary>& heard,
           std::shared_ptr<const SourceGraph> graph, std::vector<bool> expected);

  /// Takes in the next event. @return as Strangers::add()
  bool add(const Event& event, Accepted& accepted);
  /// Takes in what messages list besides.
  void addList(const Event& event, Accepted& accepted) { strangers_.addList(event, accepted); }
  /// As Strangers::addUnknown().
  void addUnknown(const Window& window, std::int64_t since, std::vector<Suspect>& suspects) const {
    strangers_.addUnknown(window, since, suspects);
  }
  /// Takes note of what events do not say, from now on.
  void set(const Senders& senders);
  /// Forgets who was heard.
  void restart();
  /// Looks at them at the end of a window.
  void closeWindow(const Heard& heard, Accepted& accepted);

  /// Whether what an event type of the model is found to do is so since it comes from another
  /// source, or does not come since it has another value.
  bool explains(EventId id, Finding finding) const {
    return moved_.moved()[id] || (isAbsence(finding) && moved_.hasOtherValue()[id]);
  }
  /// The event types that may be silent, and those that come from another source, by id.
  std::vector<bool> needNotCome(std::vector<bool> may_be_silent) const;
  /// Event types of the model whose components are there twice: what is unusual of theirs is that.
  std::vector<EventId> doubled() const;
  /// As Strangers::silences().
  std::map<std::string, std::int64_t> silences(std::int64_t now) const {
    return strangers_.silences(now);
  }
  /// What is suspicious, in words, as Judgement::evidence; strangers are only once.
  std::set<std::string> evidence() const;
  /// Whether some are there twice for longer than a restart takes.
  bool isAbnormal() const { return two_senders_.last(); }

  /// Who explains what is unusual: who is there twice, who plays, and one stranger,
  /// or who sent to it what training never saw.
  /// @param since as Strangers::addUnknown()
  /// @param unusual who is first without them
  std::vector<Suspect> causes(const Window& window, const Scorer& scorer, std::int64_t since,
                              const Suspect& unusual) const;
  /// All others, which explain nothing.
  std::vector<Suspect> strangers(const Window& window, const Scorer& scorer,
                                 std::int64_t since) const {
    return strangers_.suspects(window, scorer, moved_, since, nullptr);
  }
  std::vector<Suspect> movers() const { return moved_.suspects(true); }
  /// Drops those of movers() from suspects that are so for being unknown.
  void dropMovers(std::vector<Suspect>& suspects) const;
  /// Those of a window in which nobody else is unusual.
  /// @param all also what is told once
  std::vector<Suspect> alone(const Window& window, const Scorer& scorer, bool all) const;

 private:
  Strangers strangers_;
  Moved moved_;
  TwoSenders two_senders_;
  Players players_;
  bool is_new_list_ = false;  // in the last window
};

}  // namespace self_awareness::core::evidence
