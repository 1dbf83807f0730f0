#include "publisher_table.h"

#include <poll.h>
#include <ros/network.h>

#include <algorithm>
#include <iterator>
#include <tuple>

#include "../text.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/ros/encoding.h"

namespace self_awareness::ros1 {
namespace {

using core::kNanosecondsPerSecond;

// Of nodes that are asked at a time; who answers does so in a few milliseconds.
constexpr std::size_t kMostAsking = 64;
// Thousands of dead nodes stay registered where nobody cleans up.
constexpr double kMostAttempts = 200;  // a second
// Of who is no more, nothing comes for longer.
constexpr std::int64_t kStillSpeaks = 10 * kNanosecondsPerSecond;
constexpr std::int64_t kPatience = 3 * kNanosecondsPerSecond;
constexpr std::int64_t kStandsFirmly = 5 * kNanosecondsPerSecond;
constexpr std::int64_t kNamedAfter = 2 * kNanosecondsPerSecond;
constexpr std::int64_t kShortestPause = kNanosecondsPerSecond / 4;
constexpr std::int64_t kLongestPause = 32 * kNanosecondsPerSecond;
// To be refused costs next to nothing, and the node may be started again at any time.
constexpr std::int64_t kLongestPauseOfTheDead = 2 * kNanosecondsPerSecond;
constexpr int kMostDoublings = 8;

}  // namespace

PublisherTable::PublisherTable(Arrivals& arrivals, const ReadLimits& limits)
    : arrivals_(arrivals),
      limits_(limits),
      in_flight_(std::make_shared<std::atomic<std::size_t>>(0)) {}

PublisherTable::~PublisherTable() = default;

void PublisherTable::setListening(const Listening& listening, std::int64_t now) {
  for (auto& [uri, node] : nodes_) {
    for (auto& [topic, publication] : node.publications) {
      publication.named = false;
    }
  }
  size_ = left_out_ = 0;
  for (const auto& [topic, publishers] : listening.topics) {
    for (const Publisher& publisher : publishers) {
      if (size_ == Subscriptions::kMost) {
        ++left_out_;
        continue;
      }
      ++size_;
      Publication& publication = publicationOf(topic, publisher, now);
      publication.named = true;
      publication.first = listening.first.count(topic) > 0;
    }
  }
  forgetOthers(listening);
}

PublisherTable::Publication& PublisherTable::publicationOf(const std::string& topic,
                                                           const Publisher& publisher,
                                                           std::int64_t now) {
  const auto [at, is_new] = nodes_.try_emplace(publisher.uri);
  Node& node = at->second;
  std::uint32_t port = 0;
  if (is_new && ros::network::splitURI(publisher.uri, node.host, port) && port < 65536) {
    node.port = static_cast<int>(port);
  }
  const auto [publication, is_new_there] = node.publications.try_emplace(topic);
  if (is_new_there) {
    publication->second.missing_since = publication->second.try_at = now;
  }
  publication->second.node = publisher.node;
  return publication->second;
}

void PublisherTable::forgetOthers(const Listening& listening) {
  for (auto node = nodes_.begin(); node != nodes_.end();) {
    auto& publications = node->second.publications;
    for (auto each = publications.begin(); each != publications.end();) {
      const Publication& publication = each->second;
      const bool stands = publication.link && publication.link->stands() &&
                          listening.topics.count(each->first) > 0;
      each = publication.named || stands ? std::next(each) : publications.erase(each);
    }
    node = publications.empty() ? nodes_.erase(node) : std::next(node);
  }
  asking_ =
      static_cast<std::size_t>(std::count_if(nodes_.begin(), nodes_.end(), [](const auto& node) {
        return node.second.request != nullptr;
      }));
  for (auto topic = topics_.begin(); topic != topics_.end();) {
    topic = topic->second.expired() ? topics_.erase(topic) : std::next(topic);
  }
}

void PublisherTable::attend(std::int64_t now) {
  std::set<std::pair<std::string, std::string>> standing;  // topic and node
  std::vector<Due> due;
  for (auto& [uri, node] : nodes_) {
    Due next{&node, nullptr, nullptr};
    for (auto& [topic, publication] : node.publications) {
      if (publication.link) {
        watchLink(publication, now);
      }
      if (publication.link) {
        if (publication.named && publication.link->stands()) {
          standing.insert({topic, publication.node});
        }
      } else if (publication.named && publication.try_at <= now &&
                 (next.publication == nullptr || publication.try_at < next.publication->try_at)) {
        next.topic = &topic;
        next.publication = &publication;
      }
    }
    if (!node.data_host.empty()) {
      onAnswer(node, now);
    } else if (node.request) {
      if (now - node.asked_at > kPatience) {
        fail(node, "does not answer", false, true, now);
      }
    } else if (next.publication != nullptr) {
      due.push_back(next);
    }
  }
  closeReplaced(standing, now);
  tokens_ = std::min(kMostAttempts, tokens_ + kMostAttempts * core::toSeconds(now - counted_at_));
  counted_at_ = now;
  std::sort(due.begin(), due.end(), [](const Due& a, const Due& b) {
    const Publication& one = *a.publication;
    const Publication& other = *b.publication;
    return std::tuple(!one.first, one.failures, one.try_at) <
           std::tuple(!other.first, other.failures, other.try_at);
  });
  for (const Due& each : due) {
    ask(each, now);
  }
}

void PublisherTable::closeReplaced(const std::set<std::pair<std::string, std::string>>& standing,
                                   std::int64_t now) {
  for (auto& [uri, node] : nodes_) {
    auto& publications = node.publications;
    for (auto each = publications.begin(); each != publications.end();) {
      const Publication& publication = each->second;
      const bool over =
          !publication.named &&
          (!publication.link || (standing.count({each->first, publication.node}) > 0 &&
                                 now - publication.link->heardAt() > kStillSpeaks));
      each = over ? publications.erase(each) : std::next(each);
    }
  }
}

void PublisherTable::watchLink(Publication& publication, std::int64_t now) {
  const bool firm = now - publication.connected_at > kStandsFirmly;
  if (publication.link->lost()) {
    const std::string why = publication.link->why();
    if (publication.missing_since == 0) {
      publication.missing_since = now;
    }
    publication.link.reset();
    postpone(publication, why, false, now);
    if (firm) {
      publication.try_at = now;
    }
  } else if (publication.link->stands()) {
    publication.missing_since = 0;
    publication.dead = false;
    publication.failures = firm ? 0 : publication.failures;
  } else if (now - publication.connected_at > kPatience) {
    publication.link.reset();
    postpone(publication, "does not answer where it says that it publishes", false, now);
  }
}

void PublisherTable::ask(const Due& due, std::int64_t now) {
  Node& node = *due.node;
  if (node.port == 0) {
    fail(node, node.host.empty() ? "the master does not know where it is" : "its address is none",
         false, true, now);
    return;
  }
  const Hosts::Answer host = hosts_.find(node.host, now);
  if (host.state == Hosts::State::kUnknown) {
    fail(node, "nobody knows its host " + printable(node.host, kLongestName), false, true, now);
  } else if (host.state == Hosts::State::kLooking) {
    due.publication->why = "its host " + printable(node.host, kLongestName) + " is looked for";
  } else if (asking_ < kMostAsking && tokens_ >= 1) {
    tokens_ -= 1;
    ++asking_;
    node.topic = *due.topic;
    node.asked_at = now;
    node.request = std::make_unique<TopicRequest>(host.ip, node.port, node.host, node.topic);
    advance(node, now);
  }
}

void PublisherTable::advance(std::int64_t now) {
  for (auto& [uri, node] : nodes_) {
    if (node.request) {
      advance(node, now);
    }
  }
}

void PublisherTable::advance(Node& node, std::int64_t now) {
  node.request->advance();
  switch (node.request->state()) {
    case TopicRequest::State::kAsking:
      return;
    case TopicRequest::State::kAnswered:
      node.data_host = node.request->host();
      node.data_port = node.request->port();
      node.request.reset();
      --asking_;
      onAnswer(node, now);
      return;
    case TopicRequest::State::kRefused:
      fail(node, node.request->why(), true, true, now);
      return;
    case TopicRequest::State::kFailed:
      fail(node, node.request->why(), false, false, now);
      return;
  }
}

void PublisherTable::onAnswer(Node& node, std::int64_t now) {
  const Hosts::Answer host = hosts_.find(node.data_host, now);
  if (host.state == Hosts::State::kFound) {
    connect(node, host.ip, now);
  } else if (host.state == Hosts::State::kUnknown || now - node.asked_at > kPatience) {
    const std::string name = printable(node.data_host, kLongestName);
    fail(node, "nobody knows the host " + name + ", where it says that it publishes", false, false,
         now);
  }
}

void PublisherTable::connect(Node& node, const std::string& ip, std::int64_t now) {
  node.data_host.clear();
  const auto found = node.publications.find(node.topic);
  if (found == node.publications.end()) {
    return;  // nobody wants it any more
  }
  Publication& publication = found->second;
  std::weak_ptr<Arrival::Topic>& known = topics_[node.topic];
  std::shared_ptr<Arrival::Topic> topic = known.lock();
  if (!topic) {
    topic = std::make_shared<Arrival::Topic>(node.topic);
    known = topic;
  }
  const auto link = std::make_shared<TopicLink>(topic, arrivals_, limits_, in_flight_);
  publication.connected_at = now;
  link->connect(ip, node.data_port);
  // The thread that receives may hold it for a moment longer.
  publication.link = {link.get(), [link](TopicLink* ending) { ending->close(); }};
}

void PublisherTable::fail(Node& node, const std::string& why, bool dead, bool all,
                          std::int64_t now) {
  for (auto& [topic, publication] : node.publications) {
    if ((all || topic == node.topic) && !publication.link) {
      postpone(publication, why, dead, now);
    }
  }
  asking_ -= node.request ? 1 : 0;
  node.request.reset();
  node.data_host.clear();
}

void PublisherTable::postpone(Publication& publication, const std::string& why, bool dead,
                              std::int64_t now) {
  publication.why = why;
  publication.dead = dead;
  const std::int64_t pause = kShortestPause << std::min(publication.failures, kMostDoublings);
  publication.try_at = now + std::min(pause, dead ? kLongestPauseOfTheDead : kLongestPause);
  ++publication.failures;
}

void PublisherTable::sockets(std::vector<pollfd>& sockets) const {
  for (const auto& [uri, node] : nodes_) {
    if (node.request) {
      sockets.push_back({node.request->socket(), node.request->events(), 0});
    }
  }
}

std::vector<Unheard> PublisherTable::unheard(std::int64_t now) const {
  std::vector<Unheard> first;
  std::vector<Unheard> others;
  for (const auto& [uri, node] : nodes_) {
    for (const auto& [topic, publication] : node.publications) {
      const bool stands = publication.link && publication.link->stands();
      std::vector<Unheard>& unheard = publication.first ? first : others;
      if (publication.named && !stands && now - publication.missing_since >= kNamedAfter &&
          unheard.size() < Subscriptions::kMostUnheard) {
        unheard.push_back({publication.node, topic, publication.why, publication.dead});
      }
    }
  }
  first.insert(first.end(), others.begin(), others.end());
  if (left_out_ > 0) {
    first.push_back({"", "", std::to_string(left_out_) + " publishers are too many", false});
  }
  return first;
}

}  // namespace self_awareness::ros1
