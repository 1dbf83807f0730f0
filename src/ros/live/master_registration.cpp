#include "self_awareness/ros/live/master_registration.h"

#include <ros/connection_manager.h>
#include <ros/names.h>
#include <ros/network.h>
#include <ros/publication.h>
#include <ros/service_manager.h>
#include <ros/this_node.h>
#include <ros/topic_manager.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <utility>

#include "../master_calls.h"
#include "slave_api.h"

namespace self_awareness::ros1 {
namespace {

using XmlRpc::XmlRpcValue;

bool knows(const Graph& graph, std::set<std::string> Graph::Topic::*nodes,
           const std::string& topic) {
  const auto known = graph.topics.find(topic);
  return known != graph.topics.end() &&
         (known->second.*nodes).count(ros::this_node::getName()) > 0;
}

// roscpp does not hear of those that registered before it did.
void tellRoscpp(const std::string& topic, const XmlRpcValue& publishers) {
  XmlRpcValue answer = publishers;
  std::set<std::string> uris;
  for (int i = 0; answer.getType() == XmlRpcValue::TypeArray && i < answer.size(); ++i) {
    uris.insert(static_cast<std::string>(answer[i]));
  }
  tellPublishers(topic, uris);
}

}  // namespace

MasterRegistration::MasterRegistration(std::vector<std::string> services)
    : service_uri_("rosrpc://" + ros::network::getHost() + ":" +
                   std::to_string(ros::ConnectionManager::instance()->getTCPPort())),
      services_(std::move(services)) {
  services_.push_back(ros::names::append(ros::this_node::getName(), "get_loggers"));
  services_.push_back(ros::names::append(ros::this_node::getName(), "set_logger_level"));
}

MasterRegistration::Master MasterRegistration::check() {
  std::optional<XmlRpcValue> answer = callMaster({{"getPid"}}).front();
  if (!answer || answer->getType() != XmlRpcValue::TypeInt) {
    return Master::kAway;
  }
  const int pid = *answer;
  const bool restarted = master_pid_ && *master_pid_ != pid;
  master_pid_ = pid;
  return restarted ? Master::kRestarted : Master::kSame;
}

std::size_t MasterRegistration::keep(const SystemState& state) {
  const std::string uri = ownUri();
  std::vector<MasterCall> calls;
  std::vector<std::string> subscribed;
  ros::this_node::getSubscribedTopics(subscribed);
  std::vector<std::string> to_tell;  // which the first calls are about
  for (const std::string& topic : subscribed) {
    if (!knows(state.graph, &Graph::Topic::subscribers, topic)) {
      calls.push_back({"registerSubscriber", {topic, "*", uri}});
      to_tell.push_back(topic);
    }
  }
  std::vector<std::string> advertised;
  ros::this_node::getAdvertisedTopics(advertised);
  for (const std::string& topic : advertised) {
    const ros::PublicationPtr publication =
        ros::TopicManager::instance()->lookupPublication(topic);
    if (publication && !knows(state.graph, &Graph::Topic::publishers, topic)) {
      calls.push_back({"registerPublisher", {topic, publication->getDataType(), uri}});
    }
  }
  for (const std::string& service : services_) {
    if (state.services.count(service) == 0 &&
        ros::ServiceManager::instance()->lookupServicePublication(service)) {
      calls.push_back({"registerService", {service, service_uri_, uri}});
    }
  }
  const auto answers = callMaster(calls);
  for (std::size_t i = 0; i < to_tell.size(); ++i) {
    if (answers[i]) {
      tellRoscpp(to_tell[i], *answers[i]);
    }
  }
  return calls.size();
}

}  // namespace self_awareness::ros1
