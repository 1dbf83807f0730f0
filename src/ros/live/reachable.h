#pragma once

#include <string>

namespace self_awareness::ros1 {

/// Whether a node's machine lets this one connect to the node. Asks it, for half a second at most;
/// the name of its host may be looked up for longer.
class Reachable {
 public:
  /// @param uri of the node's XML-RPC server; empty: the master does not know it
  explicit Reachable(const std::string& uri);

  /// Why there is no connection to what it publishes, as far as this tells; never empty.
  const std::string& why() const { return why_; }
  /// Its machine says that nobody listens at its address: it is dead.
  bool nobodyListens() const { return nobody_listens_; }

 private:
  std::string why_;
  bool nobody_listens_ = false;
};

}  // namespace self_awareness::ros1
