#pragma once

#include <functional>
#include <memory>
#include <string>

namespace self_awareness {

/// Runs a node: makes what it consists of once the master has answered, and lets it live until a
/// signal or endNode() ends it.
/// @return exit code: 1 if `make` throws, else 0
int runNode(int argc, char** argv, const std::string& name,
            const std::function<std::shared_ptr<void>()>& make);

/// Ends the node soon. May be called in any thread.
void endNode();

}  // namespace self_awareness
