// Needs a master: this process publishes, and listens to itself.

#include "self_awareness/ros/live/live_events.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <ros/xmlrpc_manager.h>
#include <std_msgs/String.h>

#include <array>
#include <boost/make_shared.hpp>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "../serialized.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/ros/graph.h"
#include "self_awareness/ros/live/subscriptions.h"
#include "self_awareness/ros/own_output.h"

namespace self_awareness::ros1 {
namespace {

constexpr std::int64_t kWindow = 100000000;       // [ns]
constexpr std::int64_t kForever = 3600000000000;  // [ns]
constexpr std::uint32_t kQueueSize = 300;
constexpr std::size_t kMegabyte = 1000000;

std::size_t residentBytes() {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word && word != "VmRSS:") {
  }
  std::size_t kibibytes = 0;
  status >> kibibytes;
  return kibibytes * 1024;
}

std_msgs::String message(const std::string& data) {
  std_msgs::String message;
  message.data = data;
  return message;
}

class LiveEventsTest : public testing::Test {
 protected:
  LiveEventsTest() {
    node_handle_.setCallbackQueue(&queue_);
    LiveEvents::Handlers handlers;
    handlers.on_event = [this](const core::Event& event) {
      types_.push_back(vocabulary_.at(event.id).type);
      attributes_ = event.attributes;
    };
    handlers.time = [this](std::int64_t ros_time, std::int64_t) { return ros_time + ahead_; };
    handlers.on_arrivals = [this] { ++wakes_; };
    handlers.on_senders = [this](const core::Senders& senders) { senders_ = senders; };
    live_events_ = std::make_unique<LiveEvents>(node_handle_, kQueueSize, handlers);
    subscriptions_ = std::make_unique<Subscriptions>(live_events_->arrivals());
    encode({});
  }

  void encode(const std::map<std::string, std::string>& type_fields, std::int64_t window = kWindow,
              const std::optional<ModeField>& mode = {}) {
    EncodingRules rules;
    rules.type_fields = type_fields;
    rules.mode = mode;
    live_events_->setEncoder(encoderOf(rules), {}, window);
  }
  std::shared_ptr<const Encoder> encoderOf(const EncodingRules& rules) {
    return std::make_shared<const Encoder>(
        rules, [this](const core::EventType& type) { return vocabulary_.intern(type); });
  }
  /// Encodes as a monitor does that keeps back for so long [ns] what may be a sibling's.
  void encodeHolding(std::int64_t hold, OwnOutput::Known known = {}) {
    const auto encoder = encoderOf({});
    live_events_->setEncoder(encoder, OwnOutput("/watch", std::move(known), encoder), kWindow,
                             hold);
  }
  /// This process as the publisher of a topic.
  static Listening ownTopic(const std::string& topic) {
    const std::string uri = ros::XMLRPCManager::instance()->getServerURI();
    return {{{topic, {{ros::this_node::getName(), uri}}}}, {}};
  }
  /// A publisher that is listened to.
  ros::Publisher advertise(const std::string& topic, bool latching = false) {
    ros::Publisher publisher = node_handle_.advertise<std_msgs::String>(topic, 0, latching);
    subscriptions_->listen(ownTopic(topic));
    await([&] { return publisher.getNumSubscribers() > 0; });
    return publisher;
  }
  /// Publishes so many messages, and waits until they have arrived.
  void publish(const ros::Publisher& publisher, const std_msgs::String& message,
               std::size_t count = 1) {
    const std::uint64_t before = live_events_->arrivals().arrived();
    for (std::size_t i = 0; i < count; ++i) {
      publisher.publish(message);
    }
    await([&] { return live_events_->arrivals().arrived() == before + count; });
  }
  void await(const std::function<bool()>& condition) {
    const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(20);
    while (!condition()) {
      ASSERT_LT(ros::WallTime::now(), deadline);
      queue_.callAvailable(ros::WallDuration(0.01));
    }
  }
  std::vector<std::string> delivered() {
    types_.clear();
    live_events_->deliver();
    return types_;
  }

  core::Senders senders_;
  using Types = std::vector<std::string>;
  ros::NodeHandle node_handle_;
  ros::CallbackQueue queue_;
  core::Vocabulary vocabulary_;
  Types types_;
  core::Attributes attributes_;  // of the last event
  std::int64_t ahead_ = 0;       // of ROS time, the time that counts [ns]
  int wakes_ = 0;
  std::unique_ptr<LiveEvents> live_events_;
  std::unique_ptr<Subscriptions> subscriptions_;
};

TEST_F(LiveEventsTest, DropsAndCountsWhatDoesNotFit) {
  const ros::Publisher publisher = advertise("/a");
  publish(publisher, message(""), kQueueSize + 7);
  EXPECT_EQ(live_events_->dropped(), 7U);
  EXPECT_EQ(delivered().size(), kQueueSize);
  EXPECT_EQ(live_events_->connections(), 1U);
  publish(publisher, message(""));
  EXPECT_EQ(delivered().size(), 1U);
  EXPECT_EQ(live_events_->dropped(), 7U);
}

TEST_F(LiveEventsTest, WhatWasLatchedTellsTheModeThatLasts) {
  encode({}, kWindow, ModeField{"/latched", "data"});
  ros::Publisher publisher = node_handle_.advertise<std_msgs::String>("/latched", 0, true);
  publisher.publish(message("DRIVING"));
  subscriptions_->listen(ownTopic("/latched"));
  await([&] { return live_events_->arrivals().arrived() == 1; });
  const std::string latched = "std_msgs/String[latched]";
  EXPECT_EQ(delivered(), (Types{latched, "std_msgs/String[mode: DRIVING]"}));
  publish(publisher, message("DOCKED"));
  EXPECT_EQ(delivered(), (Types{"std_msgs/String[mode: DOCKED]", "std_msgs/String"}));
  // Another model, for which nobody says it again.
  encode({}, kWindow, ModeField{"/latched", "data"});
  EXPECT_EQ(delivered(), (Types{latched, "std_msgs/String[mode: DOCKED]"}));
  EXPECT_EQ(delivered(), Types{});
}

TEST_F(LiveEventsTest, WhatMessagesListIsToldBesidesThemAndTheirHeadersAreRead) {
  const std::string type = "diagnostic_msgs/DiagnosticArray";
  encode({{type, "status.level"}});
  const ros::Publisher publisher =
      node_handle_.advertise<diagnostic_msgs::DiagnosticArray>("/list", 10);
  subscriptions_->listen(ownTopic("/list"));
  await([&] { return publisher.getNumSubscribers() > 0; });
  diagnostic_msgs::DiagnosticArray message;
  message.status.resize(2);
  for (int number = 1; number <= 3; ++number) {
    message.header.stamp = ros::Time::now() - ros::Duration(100);
    message.status[1].level = static_cast<signed char>(number / 3);
    publisher.publish(message);
    await([&] { return live_events_->arrivals().arrived() == static_cast<unsigned>(number); });
  }
  EXPECT_EQ(delivered(), (Types{type + "[lists status.level: 0]", type, type,
                                type + "[lists status.level: 1]", type}));
  EXPECT_NEAR(core::ageOf(attributes_.age), 100, 10);
  EXPECT_EQ(attributes_.step, core::Attributes::Step::kNext);
}

TEST_F(LiveEventsTest, WhereRosTimeDoesNotCountAttributesAreNotKnown) {
  const ros::Publisher publisher = advertise("/a");
  for (const std::int64_t ahead : {0L, 1L, 0L}) {
    ahead_ = ahead;
    publish(publisher, message(""));
    EXPECT_EQ(delivered(), Types{"std_msgs/String"});
    EXPECT_EQ(attributes_.isKnown(), ahead == 0);
  }
}

TEST_F(LiveEventsTest, WhatASiblingSaidBeforeItWasKnownIsNoEvent) {
  encodeHolding(kForever);
  const ros::Publisher publisher = advertise("/diagnostics");
  publish(publisher, message("early"));
  EXPECT_EQ(delivered(), Types());
  EXPECT_EQ(live_events_->connections(), 1U);
  Graph graph;
  graph.topics["/any/status"] = {"self_awareness/SelfAwareness", {ros::this_node::getName()}, {}};
  live_events_->setGraph(graph);
  EXPECT_EQ(live_events_->connections(), 0U);
  encodeHolding(1);
  live_events_->setGraph(graph);
  publish(publisher, message("late"));
  EXPECT_EQ(delivered(), Types());
}

TEST_F(LiveEventsTest, WhoTurnsOutToBeNoSiblingIsHeardAfterAll) {
  encodeHolding(kWindow);
  ros::Publisher publisher = advertise("/diagnostics");
  publish(publisher, message(""));
  live_events_->deliver();
  publisher.shutdown();
  live_events_->forgetClosedConnections();
  await([&] {
    live_events_->deliver();
    return !types_.empty();
  });
  EXPECT_EQ(types_, Types{"std_msgs/String"});
  EXPECT_EQ(delivered(), Types());
}

TEST_F(LiveEventsTest, KeepsBackNoMoreThanASiblingSays) {
  encodeHolding(kForever);
  const ros::Publisher publisher = advertise("/diagnostics");
  publish(publisher, message(""), LiveEvents::kMostHeld - 1);
  EXPECT_EQ(delivered(), Types());
  publish(publisher, message(""));
  EXPECT_EQ(delivered().size(), LiveEvents::kMostHeld);
  publish(publisher, message(""));
  EXPECT_EQ(delivered().size(), 1U);
}

TEST_F(LiveEventsTest, KeepsBackOnlyWhatNodesSayOfThemselvesAndTheModelDoesNotKnow) {
  encodeHolding(kForever);
  const ros::Publisher other = advertise("/a");
  publish(other, message(""));
  EXPECT_EQ(delivered().size(), 1U);
  encodeHolding(kForever, {{ros::this_node::getName(), "/diagnostics"}});
  const ros::Publisher known = advertise("/diagnostics");
  publish(known, message(""));
  EXPECT_EQ(delivered().size(), 1U);
}

TEST_F(LiveEventsTest, TwoOfOneProcessDoNotDisturbEachOther) {
  LiveEvents::Handlers handlers;
  Types others;
  handlers.on_event = [&](const core::Event& event) {
    others.push_back(vocabulary_.at(event.id).type);
  };
  handlers.on_arrivals = [] {};
  LiveEvents other(node_handle_, kQueueSize, handlers);
  Subscriptions others_subscriptions(other.arrivals());
  EncodingRules rules;
  rules.type_fields = {{"std_msgs/String", "data"}};
  other.setEncoder(encoderOf(rules), {}, kWindow);
  const ros::Publisher publisher = advertise("/a");
  others_subscriptions.listen(ownTopic("/a"));
  for (std::uint64_t i = 1; i <= 2; ++i) {
    publish(publisher, message("on"));
    await([&] { return other.arrivals().arrived() == i; });
    EXPECT_EQ(delivered(), Types{"std_msgs/String"});
    other.deliver();
  }
  EXPECT_EQ(others, Types(2, "std_msgs/String[data=on]"));
}

TEST_F(LiveEventsTest, WhatWaitsTakesBoundedMemory) {
  const ros::Publisher publisher = advertise("/a");
  const std_msgs::String big = message(std::string(4 * kMegabyte, ' '));
  publish(publisher, message("small"));  // of large ones, the content is dropped once one was read
  ASSERT_EQ(delivered().size(), 1U);
  const std::size_t before = residentBytes();
  for (int i = 0; i < 100; ++i) {
    publish(publisher, big);
  }
  EXPECT_LT(residentBytes(), before + Arrivals::kMostBytes + 40 * kMegabyte);  // of 400
  EXPECT_EQ(delivered().size() + live_events_->dropped(), 100U);
  EXPECT_GT(live_events_->dropped(), 40U);
}

TEST_F(LiveEventsTest, OfLargeMessagesOneASecondIsRead) {
  const ros::Publisher publisher = advertise("/a");
  const std::string content(LiveEvents::kLarge, ' ');
  publish(publisher, message(content + "a"));
  EXPECT_EQ(delivered().size(), 1U);
  publish(publisher, message(content + "b"));
  publish(publisher, message(content + "b"));
  EXPECT_EQ(delivered().size(), 2U);
  EXPECT_FALSE(attributes_.same) << "it was not read";
  EXPECT_TRUE(attributes_.isKnown()) << "its size is known";
  ros::WallDuration(1e-9 * LiveEvents::kBetweenReads).sleep();
  publish(publisher, message(content + "a"));
  EXPECT_EQ(delivered().size(), 1U);
  EXPECT_TRUE(attributes_.same) << "as the one that was read a second ago";
  publish(publisher, message(content + "b"));
  EXPECT_EQ(delivered().size(), 1U);
  EXPECT_TRUE(attributes_.same) << "until the next one is read";
  publish(publisher, message(content + "c"));
  std::vector<Arrival> waiting;
  live_events_->arrivals().take(waiting);
  ASSERT_EQ(waiting.size(), 1U);
  EXPECT_EQ(waiting.front().message, nullptr) << "images that wait would fill the memory";
  EXPECT_EQ(waiting.front().size, content.size() + 1 + sizeof(std::uint32_t));
}

TEST_F(LiveEventsTest, AChangeOfReadingIsNoNewConnection) {
  const ros::Publisher publisher = advertise("/latched", true);
  publish(publisher, message("first"));
  const Types latched{"std_msgs/String[latched]"};
  EXPECT_EQ(delivered(), latched);
  for (int i = 0; i < 3; ++i) {
    // What is latched comes again to each new subscription; it is no event for that.
    publish(publisher, message("waits"));
    encode({{"std_msgs/String", "data"}});
    EXPECT_EQ(delivered(), (Types{latched[0], "std_msgs/String[data=waits]"}))
        << "what waits is read, and what was latched told to another model, unsent";
    publish(publisher, message("on"));
    EXPECT_EQ(delivered(), Types{"std_msgs/String[data=on]"});
    encode({});
    EXPECT_EQ(delivered(), latched);
    publish(publisher, message("on"));
    EXPECT_EQ(delivered(), Types{"std_msgs/String"});
  }
  EXPECT_EQ(publisher.getNumSubscribers(), 1U);
  EXPECT_EQ(live_events_->connections(), 1U);
  EXPECT_EQ(live_events_->dropped(), 0U);
}

TEST_F(LiveEventsTest, WakesForANewWindow) {
  const ros::Publisher publisher = advertise("/a");
  publish(publisher, message(""));
  await([&] { return wakes_ == 1; });
  ros::WallDuration(1.5e-9 * kWindow).sleep();
  publish(publisher, message(""));
  await([&] { return wakes_ == 2; });
}

TEST_F(LiveEventsTest, WakesBeforeItsQueueIsFull) {
  encode({}, 1000000 * kWindow);
  const ros::Publisher publisher = advertise("/a");
  publish(publisher, message(""), kQueueSize / 2);
  await([&] { return wakes_ == 1; });  // for the window
  publish(publisher, message(""));
  await([&] { return wakes_ == 2; });
  EXPECT_EQ(live_events_->dropped(), 0U);
}

TEST_F(LiveEventsTest, TwoConnectionsOfOneNameThatSpeakInTurnAreTwoSenders) {
  const auto topic = std::make_shared<const std::string>("/scan");
  const auto any = boost::make_shared<const topic_tools::ShapeShifter>();
  auto now = static_cast<std::int64_t>(ros::SteadyTime::now().toNSec());
  const std::array<boost::shared_ptr<ros::M_string>, 2> connections{
      headerOf<std_msgs::String>("/lidar"), headerOf<std_msgs::String>("/lidar")};
  for (std::size_t k = 0; k < 10; ++k) {
    now += kWindow;
    live_events_->arrivals().add({topic, connections[k % 2], now, now, any});
  }
  delivered();
  EXPECT_EQ(senders_.doubled, std::set<core::SourceGraph::Publication>({{"/lidar", "/scan"}}));
}

}  // namespace
}  // namespace self_awareness::ros1

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "live_events_test");
  ros::start();
  return RUN_ALL_TESTS();
}
