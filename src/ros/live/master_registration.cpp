#include "self_awareness/ros/live/master_registration.h"

#include <ros/connection_manager.h>
#include <ros/master.h>
#include <ros/names.h>
#include <ros/network.h>
#include <ros/publication.h>
#include <ros/service_manager.h>
#include <ros/this_node.h>
#include <ros/topic_manager.h>
#include <ros/xmlrpc_manager.h>
#include <xmlrpcpp/XmlRpcClient.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <utility>

#include "master_calls.h"

namespace self_awareness::ros1 {
namespace {

using XmlRpc::XmlRpcValue;

std::set<std::string> topicsOfRoscpp() {
  std::vector<std::string> topics;
  ros::TopicManager::instance()->getSubscribedTopics(topics);
  return {topics.begin(), topics.end()};
}

bool knows(const Graph& graph, std::set<std::string> Graph::Topic::*nodes,
           const std::string& topic) {
  const auto known = graph.topics.find(topic);
  return known != graph.topics.end() &&
         (known->second.*nodes).count(ros::this_node::getName()) > 0;
}

// roscpp does not hear of those that registered before it did: by the slave API, it does.
void tellRoscpp(const std::string& topic, const XmlRpcValue& publishers) {
  const ros::XMLRPCManager& own = *ros::XMLRPCManager::instance();
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(own.getServerURI(), host, port)) {
    return;
  }
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  XmlRpcValue request;
  request[0] = ros::this_node::getName();
  request[1] = topic;
  request[2] = publishers;
  XmlRpcValue ignored;
  client.execute("publisherUpdate", request, ignored);
}

}  // namespace

MasterRegistration::MasterRegistration(std::vector<std::string> services)
    : service_uri_("rosrpc://" + ros::network::getHost() + ":" +
                   std::to_string(ros::ConnectionManager::instance()->getTCPPort())),
      services_(std::move(services)) {
  services_.push_back(ros::names::append(ros::this_node::getName(), "get_loggers"));
  services_.push_back(ros::names::append(ros::this_node::getName(), "set_logger_level"));
}

MasterRegistration::~MasterRegistration() {
  const std::string uri = ros::XMLRPCManager::instance()->getServerURI();
  const std::set<std::string> of_roscpp = topicsOfRoscpp();
  MasterCalls calls;
  for (const std::string& topic : listens_to_) {
    if (of_roscpp.count(topic) == 0) {
      calls.add("unregisterSubscriber", {topic, uri});
    }
  }
  calls.execute();
}

MasterRegistration::Master MasterRegistration::check() {
  XmlRpcValue request;
  request[0] = ros::this_node::getName();
  XmlRpcValue response;
  XmlRpcValue pid;
  if (!ros::master::execute("getPid", request, response, pid, false) ||
      pid.getType() != XmlRpcValue::TypeInt) {
    return Master::kAway;
  }
  const bool restarted = master_pid_ && *master_pid_ != static_cast<int>(pid);
  master_pid_ = static_cast<int>(pid);
  return restarted ? Master::kRestarted : Master::kSame;
}

std::size_t MasterRegistration::keep(const SystemState& state,
                                     const std::set<std::string>& topics) {
  const std::string uri = ros::XMLRPCManager::instance()->getServerURI();
  const std::set<std::string> of_roscpp = topicsOfRoscpp();
  MasterCalls calls;
  std::size_t vanished = 0;
  std::vector<std::string> to_tell;  // topics of roscpp, which the first calls are about
  for (const std::string& topic : of_roscpp) {
    if (!knows(state.graph, &Graph::Topic::subscribers, topic)) {
      calls.add("registerSubscriber", {topic, "*", uri});
      to_tell.push_back(topic);
      ++vanished;
    }
  }
  for (const std::string& topic : topics) {
    const bool was_there = !listens_to_.insert(topic).second;
    if (of_roscpp.count(topic) == 0 && !knows(state.graph, &Graph::Topic::subscribers, topic)) {
      calls.add("registerSubscriber", {topic, "*", uri});
      vanished += was_there ? 1 : 0;
    }
  }
  for (auto topic = listens_to_.begin(); topic != listens_to_.end();) {
    if (topics.count(*topic) > 0) {
      ++topic;
      continue;
    }
    if (of_roscpp.count(*topic) == 0) {
      calls.add("unregisterSubscriber", {*topic, uri});
    }
    topic = listens_to_.erase(topic);
  }
  std::vector<std::string> advertised;
  ros::TopicManager::instance()->getAdvertisedTopics(advertised);
  for (const std::string& topic : advertised) {
    const ros::PublicationPtr publication =
        ros::TopicManager::instance()->lookupPublication(topic);
    if (publication && !knows(state.graph, &Graph::Topic::publishers, topic)) {
      calls.add("registerPublisher", {topic, publication->getDataType(), uri});
      ++vanished;
    }
  }
  for (const std::string& service : services_) {
    if (state.services.count(service) == 0 &&
        ros::ServiceManager::instance()->lookupServicePublication(service)) {
      calls.add("registerService", {service, service_uri_, uri});
      ++vanished;
    }
  }
  const auto answers = calls.execute();
  for (std::size_t i = 0; i < to_tell.size(); ++i) {
    if (answers[i]) {
      tellRoscpp(to_tell[i], *answers[i]);
    }
  }
  return vanished;
}

}  // namespace self_awareness::ros1
