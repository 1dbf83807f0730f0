// Needs a master: this process publishes, and discovers itself.

#include "node/discovery.h"

#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/network.h>
#include <ros/ros.h>
#include <ros/xmlrpc_manager.h>
#include <std_msgs/String.h>
#include <xmlrpcpp/XmlRpcClient.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <memory>
#include <string>
#include <vector>

#include "../await.h"

namespace self_awareness {
namespace {

constexpr int kAtOnce = 5;  // [s]: what the monitor promises

/// Says something to the master, as any stranger can.
XmlRpc::XmlRpcValue tellMaster(const std::string& method,
                               const std::vector<std::string>& arguments) {
  XmlRpc::XmlRpcValue request;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    request[static_cast<int>(i)] = arguments[i];
  }
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue answer;
  EXPECT_TRUE(ros::master::execute(method, request, response, answer, false));
  return answer;
}

std::string ownUri() {
  return ros::XMLRPCManager::instance()->getServerURI();
}

/// A publisher that only the master knows.
class MadeUpPublisher {
 public:
  MadeUpPublisher(std::string node, std::string topic, std::string uri)
      : node_(std::move(node)), topic_(std::move(topic)), uri_(std::move(uri)) {
    tellMaster("registerPublisher", {node_, topic_, "std_msgs/String", uri_});
  }
  ~MadeUpPublisher() { tellMaster("unregisterPublisher", {node_, topic_, uri_}); }
  MadeUpPublisher(const MadeUpPublisher&) = delete;
  MadeUpPublisher& operator=(const MadeUpPublisher&) = delete;

 private:
  const std::string node_;
  const std::string topic_;
  const std::string uri_;
};

class DiscoveryTest : public testing::Test {
 protected:
  DiscoveryTest() {
    node_handle_.setCallbackQueue(&never_served_);
    wanted_.model_topics = {"/a", "/b"};
    wanted_.encoder = std::make_shared<ros1::Encoder>(ros1::EncodingRules(), nullptr);
  }
  /// @param interval between polls [s]
  std::unique_ptr<Discovery> discover(double interval = 0.1) {
    auto discovery = std::make_unique<Discovery>(arrivals_, ros1::SubscribePolicy::kModel,
                                                 interval, std::vector<std::string>());
    discovery->setWanted(wanted_);
    return discovery;
  }
  ros::Publisher publish(const std::string& topic) {
    return node_handle_.advertise<std_msgs::String>(topic, 1);
  }
  /// Whether a message that is published now is heard.
  bool hears(const ros::Publisher& publisher, int seconds = kAtOnce) {
    const std::uint64_t before = arrivals_.arrived();
    return await(
        [&] {
          publisher.publish(std_msgs::String());
          return arrivals_.arrived() > before;
        },
        seconds);
  }
  static bool knows(const Discovery& discovery, const std::string& topic) {
    const std::shared_ptr<const ros1::Graph> graph = discovery.state().graph;
    return graph && graph->topics.count(topic) > 0 &&
           graph->topics.at(topic).publishers.count(ros::this_node::getName()) > 0;
  }
  static bool masterKnows(int kind, const std::string& topic) {
    XmlRpc::XmlRpcValue state = tellMaster("getSystemState", {"/test"})[kind];
    for (int i = 0; i < state.size(); ++i) {
      for (int k = 0; k < state[i][1].size(); ++k) {
        if (static_cast<std::string>(state[i][0]) == topic &&
            static_cast<std::string>(state[i][1][k]) == ros::this_node::getName()) {
          return true;
        }
      }
    }
    return false;
  }
  /// Why a publisher is not heard; empty: nothing is said of it.
  static std::string whyUnheard(const Discovery& discovery, const std::string& node) {
    for (const ros1::Unheard& unheard : discovery.unheard()) {
      if (unheard.node == node) {
        return unheard.why;
      }
    }
    return "";
  }

  ros::NodeHandle node_handle_;
  ros::CallbackQueue never_served_;
  ros1::Arrivals arrivals_{1, [] {}};
  Discovery::Wanted wanted_;
};

TEST_F(DiscoveryTest, TopicsOfTheModelAreHeardUnderTheNamesThatThisRobotHasForThem) {
  ros1::EncodingRules rules;
  rules.renames = {{"/r[0-9]+/(.*)", "/\\1"}};
  wanted_.encoder = std::make_shared<ros1::Encoder>(rules, nullptr);
  const ros::Publisher of_model = publish("/r7/a");
  const ros::Publisher other = publish("/r7/c");
  const auto discovery = discover();
  EXPECT_TRUE(hears(of_model));
  EXPECT_EQ(other.getNumSubscribers(), 0U);
}

TEST_F(DiscoveryTest, KeepsTheNewestGraph) {
  const auto discovery = discover(0.05);
  const ros::Publisher first = publish("/a");
  EXPECT_TRUE(await([&] { return knows(*discovery, "/a"); }));
  ros::Publisher second = publish("/b");
  EXPECT_TRUE(await([&] { return knows(*discovery, "/b"); }));
  second.shutdown();
  EXPECT_TRUE(await([&] { return !knows(*discovery, "/b"); }));
  EXPECT_TRUE(knows(*discovery, "/a"));
}

TEST_F(DiscoveryTest, WhomAForgedUpdateDisconnectsIsHeardAgain) {
  const auto discovery = discover();
  const ros::Publisher publisher = publish("/a");
  ASSERT_TRUE(await([&] { return publisher.getNumSubscribers() == 1; }));
  std::string host;
  std::uint32_t port = 0;
  ASSERT_TRUE(ros::network::splitURI(ownUri(), host, port));
  XmlRpc::XmlRpcClient slave(host.c_str(), static_cast<int>(port), "/");
  XmlRpc::XmlRpcValue request;
  request[0] = "/master";
  request[1] = "/a";
  request[2].setSize(0);
  XmlRpc::XmlRpcValue response;
  ASSERT_TRUE(slave.execute("publisherUpdate", request, response));
  EXPECT_TRUE(hears(publisher));
  EXPECT_EQ(whyUnheard(*discovery, ros::this_node::getName()), "");
}

TEST_F(DiscoveryTest, WhatTheMasterForgetsIsRegisteredAgain) {
  const auto discovery = discover();
  const ros::Publisher publisher = publish("/a");
  ASSERT_TRUE(await([&] { return masterKnows(1, "/a"); }));
  tellMaster("unregisterSubscriber", {ros::this_node::getName(), "/a", ownUri()});
  tellMaster("unregisterPublisher", {ros::this_node::getName(), "/a", ownUri()});
  EXPECT_TRUE(await([&] { return masterKnows(1, "/a") && masterKnows(0, "/a"); }, kAtOnce));
  EXPECT_TRUE(hears(publisher));
}

TEST_F(DiscoveryTest, TakesItsRegistrationsBack) {
  auto discovery = discover();
  ASSERT_TRUE(await([&] { return masterKnows(1, "/a") && masterKnows(1, "/b"); }));
  wanted_.model_topics = {"/b"};
  discovery->setWanted(wanted_);
  EXPECT_TRUE(await([&] { return !masterKnows(1, "/a"); }));
  EXPECT_TRUE(masterKnows(1, "/b"));
  discovery.reset();
  EXPECT_FALSE(masterKnows(1, "/b"));
}

TEST_F(DiscoveryTest, NamesWhoCannotBeReachedAndHearsTheOthersAtOnce) {
  std::vector<std::unique_ptr<MadeUpPublisher>> unreachable;
  for (int i = 0; i < 8; ++i) {
    const std::string number = std::to_string(i);
    unreachable.push_back(std::make_unique<MadeUpPublisher>(
        "/lost_" + number, "/a", "http://no-such-host-" + number + ".invalid:1/"));
  }
  const MadeUpPublisher refused("/refused", "/a", "http://127.0.0.1:9/");
  const MadeUpPublisher senseless("/senseless", "/a", "http://senseless");
  const ros::Publisher publisher = publish("/a");
  const auto discovery = discover();
  EXPECT_TRUE(hears(publisher, 20)) << "roscpp looks up one host after the other";
  EXPECT_TRUE(await([&] { return discovery->unheard().size() == 10; }));
  EXPECT_TRUE(await([&] {
    return whyUnheard(*discovery, "/lost_7") == "nobody knows its host no-such-host-7.invalid" &&
           whyUnheard(*discovery, "/refused") == "nobody listens at its address" &&
           whyUnheard(*discovery, "/senseless") == "its address is none";
  }));
  EXPECT_EQ(whyUnheard(*discovery, ros::this_node::getName()), "");
  unreachable.clear();
  EXPECT_TRUE(await([&] { return discovery->unheard().size() == 2; }));
}

}  // namespace
}  // namespace self_awareness

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "discovery_test");
  ros::start();
  return RUN_ALL_TESTS();
}
