// A component for tests: publishes std_msgs/String on a timer, or in answer to another topic.
//
// Private parameters: ~output (topic), ~rate [Hz] or ~input (topic), ~delay [s] before an answer;
// ~variation (0 to 1), the share by which periods and delays vary at most.

#include <ros/ros.h>
#include <std_msgs/String.h>

#include <functional>
#include <random>
#include <string>

int main(int argc, char** argv) {
  ros::init(argc, argv, "talker", ros::init_options::NoRosout);
  ros::NodeHandle node_handle;
  const ros::NodeHandle parameters("~");
  const double variation = parameters.param("variation", 0.0);
  const double delay = parameters.param("delay", 0.0);
  std::mt19937 random{std::random_device{}()};
  std::uniform_real_distribution<double> vary(1 - variation, 1 + variation);
  const ros::Publisher publisher = node_handle.advertise<std_msgs::String>(
      parameters.param<std::string>("output", "/talker"), 10);
  if (parameters.hasParam("input")) {
    const std::function<void(const std_msgs::StringConstPtr&)> answer =
        [&](const std_msgs::StringConstPtr& /*message*/) {
          ros::WallDuration(delay * vary(random)).sleep();
          publisher.publish(std_msgs::String());
        };
    const ros::Subscriber subscriber = node_handle.subscribe<std_msgs::String>(
        parameters.param<std::string>("input", ""), 10, answer);
    ros::spin();
    return 0;
  }
  const double period = 1 / parameters.param("rate", 1.0);
  while (ros::ok()) {
    publisher.publish(std_msgs::String());
    ros::WallDuration(period * vary(random)).sleep();
  }
}
