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
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/stream/windows.h"
#include "self_awareness/core/verdict/source_graph.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::evidence {

/// Whether every new node may send on a topic: that it does explains nothing.
bool isForEverybody(const std::string& topic);

/// Adds the unknown event types of a window that are not among its suspects yet, as long as these
/// are fewer than kMostSuspects.
void addUnknown(const Window& window, std::vector<Suspect>& suspects);

/// Knows the senders that training never saw, on topics that it knows from others: what is unusual
/// while they send is most likely their doing (docs/method.md, section 6).
class Strangers {
 public:
  /// @param heard event types by id, those of the model first, then those that it does not know;
  /// may grow. None: they are not known, so nobody is a stranger
  /// @param graph that says what training knows by name only
  Strangers(const Model& model, std::shared_ptr<const Vocabulary> heard,
            std::shared_ptr<const SourceGraph> graph);

  /// Takes in the next event, of any id.
  /// @param excused knows who is accepted
  /// @return whether training does not know it, not even by its name: to hear what was published
  /// then, and had no subscriber, is no news; nor is who is accepted, nor a line below ERROR on
  /// /rosout of who was there
  bool add(const Event& event, Accepted& accepted);
  /// Forgets who was heard: a new recording starts, or the clock was set.
  void restart() { last_.clear(); }
  /// Time since somebody was heard who sends event types that the model does not know, by source
  /// [ns], at a time [ns]; empty where these types are not known.
  std::map<std::string, std::int64_t> silences(std::int64_t now) const;
  /// Those that were heard in the last kRateSpan, without those that have the place of others.
  /// @param scorer of the same recording, at the end of the window
  std::vector<Suspect> suspects(const Window& window, const Scorer& scorer,
                                const Moved& moved) const;

 private:
  bool isStranger(EventId id) const;
  bool isKnownByName(EventId id) const;
  bool isUsualLine(EventId id) const;

  std::map<std::string, std::vector<EventId>> known_;  // event types of the model, by topic
  std::size_t size_;                                   // of the model
  std::set<std::string> sources_;                      // of the training
  std::set<SourceGraph::Publication> of_model_;
  std::shared_ptr<const Vocabulary> heard_;
  std::shared_ptr<const SourceGraph> graph_;
  std::map<EventId, bool> known_by_name_;  // unknown types that were looked at
  std::map<EventId, std::int64_t> last_;   // stamp of the last event of an unknown type [ns]
};

}  // namespace self_awareness::core::evidence
