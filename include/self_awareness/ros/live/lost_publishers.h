#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace self_awareness::ros1 {

/// One of this process's connections to publishers.
struct Link {
  std::string uri;  ///< of the publisher's XML-RPC server
  std::string topic;
  bool connected = false;
};

/// Whether a connection stands. roscpp does not say, but describes each by its port and socket:
/// when it has lost one, it may leave the description as it was for ever.
bool isConnected(const std::string& description);

/// All of them; none if roscpp is shutting down. Asks this process itself by XML-RPC: with a
/// hundred connections, that costs a few milliseconds.
std::vector<Link> linksToPublishers();

/// Whether somebody listens at an address.
enum class Reached {
  kYes,
  kRefused,  ///< nobody does, as far as its machine says
  kNoAnswer
};

/// Connects to the address of a URI; waits for half a second.
Reached reach(const std::string& uri);

/// Finds publishers that live, but are connected no more. roscpp takes a node that was killed and
/// started again with the same URI for the one that it was connected to: it goes on calling that
/// one's former port.
///
/// Times are steady [ns].
class LostPublishers {
 public:
  explicit LostPublishers(std::function<Reached(const std::string& uri)> reach = ros1::reach)
      : reach_(std::move(reach)) {}

  /// Looks once more. Returns topics to subscribe to again.
  std::set<std::string> look(const std::vector<Link>& links, std::int64_t now);

 private:
  struct Lost {
    std::set<std::string> topics;  // to ask for
    std::set<std::string> asked;   // and not connected again yet
    std::int64_t try_at = 0;
    std::int64_t pause = 0;  // after the next try
  };
  using Publication = std::pair<std::string, std::string>;  // URI and topic

  /// Notes which connections are lost: at two looks, since one may just be made.
  void compare(const std::vector<Link>& links, std::int64_t now);
  Reached tryAgain(const std::string& uri, Lost& lost, std::int64_t now,
                   std::set<std::string>& again);

  const std::function<Reached(const std::string& uri)> reach_;
  std::set<Publication> links_;       // at the last look
  std::map<std::string, Lost> lost_;  // by URI
};

}  // namespace self_awareness::ros1
