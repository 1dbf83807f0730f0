#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

namespace self_awareness::ros1 {

/// Addresses of hosts, looked up in the background: a resolver may take half a minute to find that
/// nobody knows a name, and nobody else may wait for that.
///
/// Belongs to one thread. Times are steady [ns].
class Hosts {
 public:
  enum class State { kFound, kLooking, kUnknown };
  struct Answer {
    State state = State::kLooking;
    std::string ip;  ///< if found
  };

  Hosts();
  ~Hosts();
  Hosts(const Hosts&) = delete;
  Hosts& operator=(const Hosts&) = delete;

  /// What is known of a host now; to be asked again while it is looked for. Addresses written as
  /// numbers are found at once.
  Answer find(const std::string& host, std::int64_t now);

 private:
  struct Lookup;
  struct Known {
    std::unique_ptr<Lookup> lookup;  // none: it has ended
    Answer answer;
    std::int64_t good_until = 0;
  };

  void start(const std::string& host, Known& known);
  void finish(Known& known, std::int64_t now);

  std::map<std::string, Known> known_;
  std::size_t looking_ = 0;
};

}  // namespace self_awareness::ros1
