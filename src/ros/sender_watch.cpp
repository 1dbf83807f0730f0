#include "self_awareness/ros/sender_watch.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "self_awareness/ros/own_output.h"
#include "self_awareness/ros/stable_name.h"

namespace self_awareness::ros1 {

// Times that messages must have come again from the one, after the other one.
constexpr std::size_t kFewestReturns = 3;
// Within so long they must have; what came before is forgotten [ns].
constexpr std::int64_t kTogether = 60 * core::kNanosecondsPerSecond;
// Who has not returned for so long, and for twice as long as the returns took, is gone [ns].
constexpr std::int64_t kGone = 5 * core::kNanosecondsPerSecond;

/// What one sender says on a topic, by its name: it may be two.
struct SenderWatch::Topic {
  /// The messages of one process, as far as they can be told apart.
  struct Line {
    std::uint64_t link = 0;             // number of its connection; 0: there is none
    std::optional<std::uint32_t> next;  // number of its next message
  };

  core::SourceGraph::Publication publication;  // as events name it
  Line current;
  Line other;                                          // the one before
  std::array<std::int64_t, kFewestReturns> returns{};  // stamps of the last ones [ns]
  std::size_t number = 0;                              // of these that there were

  /// Takes in a message. @return whether it is of the one that had spoken before the last one
  bool add(std::uint64_t link, std::optional<std::uint32_t> message);
};

class SenderWatch::Link {
 public:
  std::uint64_t number = 0;              // from 1
  std::shared_ptr<Topic> topic;          // null: of a player
  std::optional<core::EventType> plays;  // on which it does
};

bool SenderWatch::Topic::add(std::uint64_t link, std::optional<std::uint32_t> message) {
  const std::optional<std::uint32_t> next =
      message ? std::optional<std::uint32_t>(*message + 1) : std::nullopt;
  const auto goesOn = [&](const Line& line) {
    return line.link == link && (!message || !line.next || *message == *line.next);
  };
  const bool apart = current.link != other.link;  // connections tell them apart
  bool returned = false;
  if (goesOn(current) || (apart && current.link == link && other.link != 0)) {
    // of the same one; some of its messages may be missing
  } else if (goesOn(other) || (apart && other.link == link)) {
    std::swap(current, other);
    returned = true;
  } else {
    other = std::exchange(current, Line{link, next});
  }
  current.next = next;
  return returned;
}

std::shared_ptr<SenderWatch::Link> SenderWatch::connect(const Connection& connection,
                                                        const Encoder& encoder) {
  if (!encoder.tellsSources() || connection.callerid.empty() ||
      !encoder.includesTopic(connection.topic) || isOwnType(connection.datatype)) {
    return nullptr;
  }
  auto link = std::make_shared<Link>();
  link->number = ++links_;
  link->plays = encoder.played(connection);
  if (!link->plays && encoder.includesSource(stableName(connection.callerid))) {
    for (auto known = topics_.begin(); known != topics_.end();) {
      known = known->second.expired() ? topics_.erase(known) : std::next(known);
    }
    std::weak_ptr<Topic>& topic = topics_[{connection.callerid, connection.topic}];
    link->topic = topic.lock();
    if (!link->topic) {
      link->topic = std::make_shared<Topic>();
      link->topic->publication = {encoder.sourceOf(connection.callerid),
                                  encoder.scopeOf(connection.topic)};
      topic = link->topic;
    }
  }
  return link->plays || link->topic ? link : nullptr;
}

void SenderWatch::add(std::int64_t stamp, Link& link, std::optional<std::uint32_t> number) {
  bool changed = false;
  if (link.plays) {
    changed = played_until_.count(*link.plays) == 0;
    played_until_[*link.plays] = stamp + kGone;
  } else if (Topic& topic = *link.topic; topic.add(link.number, number)) {
    std::rotate(topic.returns.begin(), topic.returns.begin() + 1, topic.returns.end());
    topic.returns.back() = stamp;
    topic.number = std::min(topic.number + 1, kFewestReturns);
    const std::int64_t span = stamp - topic.returns.front();
    if (topic.number == kFewestReturns && span <= kTogether) {
      changed = doubled_until_.count(topic.publication) == 0;
      doubled_until_[topic.publication] = stamp + std::max(kGone, 2 * span);
    }
  }
  if (changed) {
    tell(stamp);
  } else {
    advance(stamp);
  }
}

void SenderWatch::advance(std::int64_t stamp) {
  const auto isOver = [stamp](const auto& each) { return each.second < stamp; };
  if (std::any_of(doubled_until_.begin(), doubled_until_.end(), isOver) ||
      std::any_of(played_until_.begin(), played_until_.end(), isOver)) {
    tell(stamp);
  }
}

void SenderWatch::restart() {
  topics_.clear();
  doubled_until_.clear();
  played_until_.clear();
  tell(0);
}

void SenderWatch::tell(std::int64_t stamp) {
  core::Senders senders;
  const auto collect = [stamp](auto& until, auto& all) {
    for (auto each = until.begin(); each != until.end();) {
      if (each->second < stamp) {
        each = until.erase(each);
      } else {
        all.insert(each->first);
        ++each;
      }
    }
  };
  collect(doubled_until_, senders.doubled);
  collect(played_until_, senders.played);
  if (senders != told_) {
    told_ = std::move(senders);
    handler_(stamp, told_);
  }
}

}  // namespace self_awareness::ros1
