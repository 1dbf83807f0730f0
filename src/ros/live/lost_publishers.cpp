#include "self_awareness/ros/live/lost_publishers.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>
#include <sys/socket.h>
#include <unistd.h>
#include <xmlrpcpp/XmlRpcClient.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstddef>
#include <optional>
#include <system_error>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::ros1 {
namespace {

constexpr int kPatience = 500;  // [ms]
// A machine that is switched off lets each look wait.
constexpr int kMostUnanswered = 4;
// To subscribe again may lose a message of another publisher of the topic: a node that comes and
// goes must not bring that about all the time.
constexpr std::int64_t kShortestPause = core::kNanosecondsPerSecond;
constexpr std::int64_t kLongestPause = 64 * core::kNanosecondsPerSecond;

Reached connectTo(const addrinfo& address) {
  const int connecting =
      socket(address.ai_family, address.ai_socktype | SOCK_CLOEXEC, address.ai_protocol);
  if (connecting < 0) {
    return Reached::kNoAnswer;
  }
  fcntl(connecting, F_SETFL, fcntl(connecting, F_GETFL) | O_NONBLOCK);
  int error = connect(connecting, address.ai_addr, address.ai_addrlen) == 0 ? 0 : errno;
  if (error == EINPROGRESS) {
    pollfd waiting{connecting, POLLOUT, 0};
    socklen_t size = sizeof error;
    if (poll(&waiting, 1, kPatience) != 1 ||
        getsockopt(connecting, SOL_SOCKET, SO_ERROR, &error, &size) != 0) {
      error = ETIMEDOUT;
    }
  }
  close(connecting);
  return error == 0              ? Reached::kYes
         : error == ECONNREFUSED ? Reached::kRefused
                                 : Reached::kNoAnswer;
}

std::optional<int> numberAfter(const std::string& words, const std::string& text) {
  const std::size_t at = text.rfind(words);
  int number = 0;
  if (at == std::string::npos ||
      std::from_chars(text.data() + at + words.size(), text.data() + text.size(), number).ec !=
          std::errc()) {
    return std::nullopt;
  }
  return number;
}

int portOf(const sockaddr_storage& address) {
  return ntohs(address.ss_family == AF_INET6
                   ? reinterpret_cast<const sockaddr_in6&>(address).sin6_port
                   : reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

}  // namespace

bool isConnected(const std::string& description) {
  const std::optional<int> port = numberAfter("connection on port ", description);
  const std::optional<int> connection = numberAfter(" on socket ", description);
  if (!port || !connection) {
    return true;  // another roscpp describes it otherwise
  }
  sockaddr_storage own{};
  sockaddr_storage other{};
  socklen_t size = sizeof own;
  socklen_t other_size = sizeof other;
  // The number of a socket that was closed may be in use for another one.
  return getsockname(*connection, reinterpret_cast<sockaddr*>(&own), &size) == 0 &&
         portOf(own) == *port &&
         getpeername(*connection, reinterpret_cast<sockaddr*>(&other), &other_size) == 0;
}

std::vector<Link> linksToPublishers() {
  // roscpp tells them to who asks by its slave API, and nowhere else.
  ros::XMLRPCManager& own = *ros::XMLRPCManager::instance();
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(own.getServerURI(), host, port)) {
    return {};
  }
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  XmlRpc::XmlRpcValue request;
  request[0] = ros::this_node::getName();
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue
      connections;  // [[id, URI, direction, transport, topic, connected, text], ...]
  std::vector<Link> links;
  if (!client.execute("getBusInfo", request, response) ||
      !own.validateXmlrpcResponse("getBusInfo", response, connections)) {
    return links;
  }
  for (int i = 0;
       connections.getType() == XmlRpc::XmlRpcValue::TypeArray && i < connections.size(); ++i) {
    XmlRpc::XmlRpcValue& connection = connections[i];
    if (connection.size() > 6 && static_cast<std::string>(connection[2]) == "i" &&
        static_cast<std::string>(connection[3]) == "TCPROS") {
      links.push_back({connection[1], connection[4], isConnected(connection[6])});
    }
  }
  return links;
}

Reached reach(const std::string& uri) {
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(uri, host, port)) {
    return Reached::kNoAnswer;
  }
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found) != 0) {
    return Reached::kNoAnswer;
  }
  Reached reached = Reached::kNoAnswer;  // localhost may have two addresses
  for (const addrinfo* address = found; address && reached != Reached::kYes;
       address = address->ai_next) {
    const Reached there = connectTo(*address);
    reached = there == Reached::kNoAnswer ? reached : there;
  }
  freeaddrinfo(found);
  return reached;
}

std::set<std::string> LostPublishers::look(const std::vector<Link>& links, std::int64_t now) {
  compare(links, now);
  std::set<std::string> again;
  int unanswered = 0;
  for (auto lost = lost_.begin(); lost != lost_.end();) {
    auto& [uri, attempt] = *lost;
    const bool nothing_to_do = attempt.topics.empty() && attempt.asked.empty();
    if (nothing_to_do && now >= attempt.try_at + kLongestPause) {
      lost = lost_.erase(lost);
      continue;
    }
    if (!nothing_to_do && now >= attempt.try_at && unanswered < kMostUnanswered) {
      unanswered += tryAgain(uri, attempt, now, again) == Reached::kNoAnswer ? 1 : 0;
    }
    ++lost;
  }
  return again;
}

void LostPublishers::compare(const std::vector<Link>& links, std::int64_t now) {
  std::set<Publication> all;
  for (const Link& link : links) {
    const Publication publication(link.uri, link.topic);
    const auto lost = lost_.find(link.uri);
    if (link.connected && lost != lost_.end()) {
      lost->second.topics.erase(link.topic);
      lost->second.asked.erase(link.topic);
    } else if (!link.connected && links_.count(publication) > 0) {
      lost_.try_emplace(link.uri, Lost{{}, {}, now, kShortestPause})
          .first->second.topics.insert(link.topic);
    }
    all.insert(publication);
  }
  links_ = std::move(all);
  // A node that is registered at another URI now, or no more, is none of ours to find.
  for (auto& [uri, lost] : lost_) {
    for (auto topic = lost.topics.begin(); topic != lost.topics.end();) {
      topic = links_.count({uri, *topic}) == 0 ? lost.topics.erase(topic) : std::next(topic);
    }
  }
}

Reached LostPublishers::tryAgain(const std::string& uri, Lost& lost, std::int64_t now,
                                 std::set<std::string>& again) {
  const Reached reached = reach_(uri);
  const bool again_only = lost.topics.empty();
  if (reached == Reached::kYes) {
    // A node that has just begun may not know of its topics yet; roscpp asks it only once.
    lost.asked.merge(lost.topics);
    lost.topics.clear();
    for (const std::string& topic : lost.asked) {
      again.insert(topic);
      links_.erase({uri, topic});  // the next one is new
    }
  }
  if (again_only && lost.pause == kLongestPause) {
    lost.asked.clear();  // another program may listen there by now
  }
  if (again_only || reached != Reached::kRefused) {
    lost.try_at = now + lost.pause;
    lost.pause = std::min(2 * lost.pause, kLongestPause);
  }
  return reached;
}

}  // namespace self_awareness::ros1
