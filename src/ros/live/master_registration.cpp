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
#include <xmlrpcpp/XmlRpcValue.h>

#include <utility>

namespace self_awareness::ros1 {
namespace {

template <typename... Arguments>
bool call(const std::string& method, XmlRpc::XmlRpcValue& payload, const Arguments&... arguments) {
  XmlRpc::XmlRpcValue request;
  int i = 0;
  request[i++] = ros::this_node::getName();
  ((request[i++] = arguments), ...);
  XmlRpc::XmlRpcValue response;
  return ros::master::execute(method, request, response, payload, false);
}

}  // namespace

MasterRegistration::MasterRegistration(std::vector<std::string> services)
    : services_(std::move(services)) {
  services_.push_back(ros::names::append(ros::this_node::getName(), "get_loggers"));
  services_.push_back(ros::names::append(ros::this_node::getName(), "set_logger_level"));
}

MasterRegistration::Master MasterRegistration::check() {
  XmlRpc::XmlRpcValue pid;
  if (!call("getPid", pid) || pid.getType() != XmlRpc::XmlRpcValue::TypeInt) {
    return Master::kAway;
  }
  const bool restarted = master_pid_ && *master_pid_ != static_cast<int>(pid);
  if (restarted) {
    registerAll();
  }
  master_pid_ = static_cast<int>(pid);
  return restarted ? Master::kRestarted : Master::kSame;
}

void MasterRegistration::registerAll() const {
  const std::string uri = ros::XMLRPCManager::instance()->getServerURI();
  XmlRpc::XmlRpcValue ignored;  // the master answers, or the next check() finds it away
  std::vector<std::string> topics;
  ros::TopicManager::instance()->getAdvertisedTopics(topics);
  for (const std::string& topic : topics) {
    const ros::PublicationPtr publication =
        ros::TopicManager::instance()->lookupPublication(topic);
    if (publication) {
      call("registerPublisher", ignored, topic, publication->getDataType(), uri);
    }
  }
  ros::TopicManager::instance()->getSubscribedTopics(topics);
  for (const std::string& topic : topics) {
    call("registerSubscriber", ignored, topic, std::string("*"), uri);
  }
  const std::string service_uri = "rosrpc://" + ros::network::getHost() + ":" +
                                  std::to_string(ros::ConnectionManager::instance()->getTCPPort());
  for (const std::string& service : services_) {
    if (ros::ServiceManager::instance()->lookupServicePublication(service)) {
      call("registerService", ignored, service, service_uri, uri);
    }
  }
}

}  // namespace self_awareness::ros1
