#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <optional>
#include <string>
#include <vector>

namespace self_awareness::ros1 {

/// Asks the master by a method without arguments, and blocks until it answers; none if it does
/// not.
std::optional<XmlRpc::XmlRpcValue> askMaster(const std::string& method);

/// Calls to the master that are made together: one by one, a few hundred would take the master,
/// and all who ask it, a good part of each second.
class MasterCalls {
 public:
  /// @param arguments after the name of this node
  void add(const std::string& method, const std::vector<std::string>& arguments);

  /// Blocks until the master has answered, or has failed to.
  /// @return what it answered to each; none where it did not, or refused
  std::vector<std::optional<XmlRpc::XmlRpcValue>> execute() const;

 private:
  struct Call {
    std::string method;
    XmlRpc::XmlRpcValue parameters;
  };

  std::vector<Call> calls_;
};

}  // namespace self_awareness::ros1
