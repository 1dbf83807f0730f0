#include "self_awareness/ros/live/subscriptions.h"

#include <ros/network.h>
#include <ros/subscribe_options.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <chrono>
#include <iterator>

#include "../text.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/ros_time.h"
#include "slave_api.h"

namespace self_awareness::ros1 {
namespace {

constexpr std::int64_t kMissing = 3 * core::kNanosecondsPerSecond;
constexpr std::int64_t kLongestPause = 60 * core::kNanosecondsPerSecond;
// Each may have to be waited for; who waits longest comes first.
constexpr std::size_t kMostAtATime = 20;
// Of large messages that wait to be copied; else Arrivals has the queue, and counts what is lost.
constexpr std::uint32_t kQueue = 20;

std::size_t numberOfAddresses(const std::set<Publisher>& publishers) {
  std::set<std::string> addresses;
  for (const Publisher& publisher : publishers) {
    addresses.insert(addressIn(publisher.uri));
  }
  return addresses.size();
}

constexpr std::chrono::milliseconds kPatience(500);
constexpr char kNobodyListens[] = "nobody listens at its address";
constexpr char kDoesNotAnswer[] = "does not answer";

/// Why there is no connection to a node, as far as its machine tells. Waits for it, and for
/// whoever knows the address of its host.
std::string whyMissing(const std::string& uri) {
  namespace asio = boost::asio;
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(uri, host, port)) {
    return uri.empty() ? "the master does not know where it is" : "its address is none";
  }
  asio::ip::tcp::iostream node;
  node.expires_after(kPatience);
  node.connect(host, std::to_string(port));
  if (node.error() == asio::error::connection_refused) {
    return kNobodyListens;
  }
  const bool unknown = node.error() == asio::error::host_not_found ||
                       node.error() == asio::error::host_not_found_try_again;
  return unknown ? "nobody knows its host " + printable(host, kLongestName) : kDoesNotAnswer;
}

}  // namespace

/// Has a message taken by the thread of roscpp that received it: it only goes to Arrivals. Where
/// messages are large, another thread copies them: if one and the same thread receives and copies,
/// malloc returns the memory of both to the system each time, and every page of the next message
/// is a fault.
class Subscriptions::Queue : public ros::CallbackQueueInterface {
 public:
  explicit Queue(ros::CallbackQueueInterface& large) : large_(large) {}
  void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t owner) override {
    if (is_large_) {
      large_.addCallback(callback, owner);
    } else {
      callback->call();
    }
  }
  void removeByID(std::uint64_t owner) override { large_.removeByID(owner); }
  void onMessage(std::size_t size) { is_large_ = is_large_ || size > Arrivals::kLarge; }

 private:
  ros::CallbackQueueInterface& large_;
  std::atomic<bool> is_large_{false};  // the topic's messages are
};

Subscriptions::Subscriptions(Arrivals& arrivals) : arrivals_(arrivals) {
  copying_.start();
}

Subscriptions::~Subscriptions() = default;

void Subscriptions::listen(const Listening& listening) {
  for (auto each = subscribers_.begin(); each != subscribers_.end();) {
    each = listening.topics.count(each->first) > 0 ? std::next(each) : subscribers_.erase(each);
  }
  for (const auto& [topic, publishers] : listening.topics) {
    if (subscribers_.count(topic) == 0) {
      subscribe(topic);
    }
  }
  const std::int64_t now = steadyNow();
  compare(listening, now);
  tellAgain(listening, now);
  std::vector<Unheard> unheard = missingFor3s(listening.first, now);
  unheard_.lock()->swap(unheard);
}

void Subscriptions::subscribe(const std::string& topic) {
  using topic_tools::ShapeShifter;
  const auto name = std::make_shared<const std::string>(topic);
  ros::NodeHandle node_handle("", {{topic, topic}});  // what the master calls so is not remapped
  Subscribed& subscribed = subscribers_[topic];
  subscribed.queue = std::make_unique<Queue>(large_);
  node_handle.setCallbackQueue(subscribed.queue.get());
  subscribed.subscriber = node_handle.subscribe<ShapeShifter>(
      topic, kQueue,
      boost::function<void(const ros::MessageEvent<const ShapeShifter>&)>(
          [this, name,
           queue = subscribed.queue.get()](const ros::MessageEvent<const ShapeShifter>& event) {
            queue->onMessage(event.getConstMessage()->size());
            arrivals_.add({name, event.getConnectionHeaderPtr(),
                           fromRosTime(event.getReceiptTime()), steadyNow(),
                           event.getConstMessage()});
          }),
      ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
}

void Subscriptions::compare(const Listening& listening, std::int64_t now) {
  const auto is_complete = [&](const auto& topic) {
    return subscribers_.at(topic.first).subscriber.getNumPublishers() ==
           numberOfAddresses(topic.second);
  };
  if (std::all_of(listening.topics.begin(), listening.topics.end(), is_complete)) {
    missing_.clear();
    return;
  }
  const std::set<std::pair<std::string, std::string>> connected = connectedPublishers();
  const auto known = std::exchange(missing_, {});
  for (const auto& [topic, publishers] : listening.topics) {
    for (const Publisher& publisher : publishers) {
      if (connected.count({topic, addressIn(publisher.uri)}) == 0) {
        const Publication publication(topic, publisher);
        const auto before = known.find(publication);
        if (before != known.end()) {
          missing_.insert(*before);
        } else {
          // Told at once: roscpp leaves alone whom it is about to connect to.
          missing_[publication] = {now, now, kMissing};
        }
      }
    }
  }
}

void Subscriptions::tellAgain(const Listening& listening, std::int64_t now) {
  std::vector<std::map<Publication, Missing>::value_type*> due;
  for (auto& each : missing_) {
    if (each.second.tell_at <= now) {
      due.push_back(&each);
    }
  }
  std::sort(due.begin(), due.end(),
            [](const auto* a, const auto* b) { return a->second.tell_at < b->second.tell_at; });
  due.resize(std::min(due.size(), kMostAtATime));
  std::set<std::string> topics;
  std::set<std::string> anew;
  for (auto* const each : due) {
    const auto& [topic, publisher] = each->first;
    Missing& missing = each->second;
    if (now - missing.since >= kMissing) {
      missing.why = whyMissing(publisher.uri);
      if (missing.why == kDoesNotAnswer) {
        anew.insert(topic);
      }
    }
    missing.tell_at = now + missing.pause;
    missing.pause = std::min(2 * missing.pause, kLongestPause);
    topics.insert(topic);
  }
  // A subscription keeps the type of whom it heard first, and hears no other one.
  for (const std::string& topic : anew) {
    subscribers_.erase(topic);
    subscribe(topic);
    topics.erase(topic);
  }
  for (const std::string& topic : topics) {
    std::set<std::string> uris;
    for (const Publisher& publisher : listening.topics.at(topic)) {
      if (!publisher.uri.empty()) {
        uris.insert(publisher.uri);
      }
    }
    tellPublishers(topic, uris);
  }
}

std::vector<Unheard> Subscriptions::missingFor3s(const std::set<std::string>& first,
                                                 std::int64_t now) const {
  std::vector<Unheard> unheard;
  for (const auto& [publication, missing] : missing_) {
    if (now - missing.since >= kMissing) {
      unheard.push_back({publication.second.node, publication.first, missing.why,
                         missing.why == kNobodyListens});
    }
  }
  std::stable_partition(unheard.begin(), unheard.end(),
                        [&](const Unheard& each) { return first.count(each.topic) > 0; });
  unheard.resize(std::min(unheard.size(), kMostUnheard));
  return unheard;
}

}  // namespace self_awareness::ros1
