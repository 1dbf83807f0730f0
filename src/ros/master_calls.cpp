#include "master_calls.h"

#include <ros/master.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>
#include <xmlrpcpp/XmlRpcClient.h>

#include <algorithm>

namespace self_awareness::ros1 {
namespace {

using XmlRpc::XmlRpcValue;
using Answers = std::vector<std::optional<XmlRpcValue>>;

constexpr std::size_t kMostTogether = 500;

bool execute(const std::string& method, const XmlRpcValue& request, XmlRpcValue& response) {
  ros::XMLRPCManager& manager = *ros::XMLRPCManager::instance();
  XmlRpc::XmlRpcClient* const client = manager.getXMLRPCClient(
      ros::master::getHost(), static_cast<int>(ros::master::getPort()), "/");
  const bool done = client->execute(method.c_str(), request, response);
  manager.releaseXMLRPCClient(client);
  return done;
}

XmlRpcValue parametersOf(const MasterCall& call) {
  XmlRpcValue parameters;
  parameters[0] = ros::this_node::getName();
  for (const std::string& argument : call.arguments) {
    parameters[parameters.size()] = argument;
  }
  return parameters;
}

std::optional<XmlRpcValue> payloadOf(const std::string& method, XmlRpcValue& response) {
  XmlRpcValue payload;
  if (!ros::XMLRPCManager::instance()->validateXmlrpcResponse(method, response, payload)) {
    return std::nullopt;
  }
  return payload;
}

}  // namespace

Answers callMaster(const std::vector<MasterCall>& calls) {
  Answers answers;
  for (std::size_t begin = 0; begin < calls.size(); begin = answers.size()) {
    const std::size_t end = std::min(begin + kMostTogether, calls.size());
    XmlRpcValue request;
    for (std::size_t i = begin; i < end; ++i) {
      XmlRpcValue& each = request[0][static_cast<int>(i - begin)];
      each["methodName"] = calls[i].method;
      each["params"] = parametersOf(calls[i]);
    }
    XmlRpcValue response;
    if (!execute("system.multicall", request, response)) {
      answers.resize(calls.size());  // nobody answers
      break;
    }
    const bool knows_it = response.getType() == XmlRpcValue::TypeArray &&
                          response.size() == static_cast<int>(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      XmlRpcValue single;
      if (knows_it) {
        XmlRpcValue& each = response[static_cast<int>(i - begin)];  // [answer], or a fault
        single = each.getType() == XmlRpcValue::TypeArray && each.size() == 1 ? each[0] : each;
      } else {
        execute(calls[i].method, parametersOf(calls[i]), single);
      }
      answers.push_back(payloadOf(calls[i].method, single));
    }
  }
  return answers;
}

}  // namespace self_awareness::ros1
