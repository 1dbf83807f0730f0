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
#include "core/evidence/presence/news.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/stream/windows.h"
#include "self_awareness/core/verdict/source_graph.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::evidence {

/// Whether every new node may send on a topic: that it does explains nothing.
bool isForEverybody(const std::string& topic);

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
  /// /rosout of who was there, but for a flood of them: least_told without a pause of kRateSpan
  bool add(const Event& event, Accepted& accepted);
  /// Takes in what messages list besides.
  void addList(const Event& event, Accepted& accepted);
  /// Whether a list that is news, and not accepted, lasts at a time [ns].
  bool anyList(std::int64_t now) const;
  /// Adds the unknown event types of a window that are not among its suspects yet, as long as
  /// these are fewer than kMostSuspects.
  /// @param since those that were there before are left out [ns]
  void addUnknown(const Window& window, std::int64_t since, std::vector<Suspect>& suspects) const;
  /// Forgets who was heard: a new recording starts, or the clock was set.
  void restart() {
    sent_.clear();
    lines_.clear();
  }
  /// Time since somebody was heard who sends event types that the model does not know, by source
  /// [ns], at a time [ns]; empty where these types are not known.
  std::map<std::string, std::int64_t> silences(std::int64_t now) const;
  /// Those that were heard in the last kRateSpan, without those that have the place of others.
  /// @param scorer of the same recording, at the end of the window
  /// @param since as addUnknown()
  /// @param unusual only those that explain why this one is so, among them who sent it what
  /// training never saw; null: all
  std::vector<Suspect> suspects(const Window& window, const Scorer& scorer, const Moved& moved,
                                std::int64_t since, const Suspect* unusual) const;

 private:
  /// An event type that training never saw, as a suspect of a window.
  Suspect unknownSuspect(EventId id, const Window& window) const;
  /// Whether it is known what type an id is of.
  bool hasType(EventId id) const { return heard_ && id < heard_->size(); }
  bool isStranger(EventId id) const;
  /// Whether it is why another one is unusual: a stranger, or what this one hears, or, where
  /// nobody knows who hears whom, any if it sends too often. No list is.
  bool explains(EventId id, const Suspect& unusual) const;
  bool isKnownByName(EventId id) const;
  bool isUsualLine(EventId id) const;
  bool isFlood(const Event& line);

  /// Takes note of an event of an unknown type.
  void note(const Event& event);
  /// Whether an unknown type came before a stamp [ns] already, without a pause of kOneCause since.
  bool wasThere(EventId id, std::int64_t stamp) const;

  /// When events of an unknown type came: stamps [ns].
  struct Sent {
    std::int64_t first = 0;  // since a pause of kOneCause
    std::int64_t last = 0;
  };
  /// Lines of a level that a sender never used.
  struct Lines {
    std::int64_t last = 0;     // stamp [ns]
    std::uint64_t number = 0;  // without a pause
  };

  std::map<std::string, std::vector<EventId>> known_;  // event types of the model, by topic
  std::size_t size_;                                   // of the model
  double most_lines_;                                  // that are no flood
  std::set<std::string> sources_;                      // of the training
  std::set<SourceGraph::Publication> of_model_;
  std::shared_ptr<const Vocabulary> heard_;
  std::shared_ptr<const SourceGraph> graph_;
  News news_;
  std::map<EventId, bool> known_by_name_;  // unknown types that were looked at
  std::map<EventId, Lines> lines_;
  std::map<EventId, Sent> sent_;  // of unknown types
};

}  // namespace self_awareness::core::evidence
