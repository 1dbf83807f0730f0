#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <optional>
#include <string>
#include <vector>

namespace self_awareness::ros1 {

/// A call to the master.
struct MasterCall {
  std::string method;
  std::vector<std::string> arguments{};  ///< after the name of this node
};

/// Makes calls to the master together: one by one, a few hundred would take the master, and all
/// who ask it, a good part of each second. Blocks until it has answered, or has failed to.
/// @return what it answered to each; none where it did not, or refused
std::vector<std::optional<XmlRpc::XmlRpcValue>> callMaster(const std::vector<MasterCall>& calls);

}  // namespace self_awareness::ros1
