#pragma once

#include <functional>
#include <memory>
#include <string>

namespace self_awareness {

/// What a node consists of. Its destructor may wait for the master.
class NodeProgram {
 public:
  virtual ~NodeProgram() = default;
  /// Ends all work and writes what must not be lost. Does not wait for the master.
  virtual void finish() = 0;
};

/// Runs a node: makes what it consists of once the master has answered, and lets it live until
/// SIGINT, SIGTERM or endNode() ends it. It is finished first; then it has 2 s to say goodbye to
/// the master, which may hang. --help and --version are answered at once, without a master.
/// @param usage what --help prints
/// @return exit code: 1 if `make` throws, else 0
int runNode(int argc, char** argv, const std::string& name, const std::string& usage,
            const std::function<std::unique_ptr<NodeProgram>()>& make);

/// Ends the node soon. May be called in any thread.
void endNode();

}  // namespace self_awareness
