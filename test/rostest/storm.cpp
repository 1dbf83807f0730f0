// A node for tests that publishes much, or in bad style.
//
// Private parameters: ~topics (std_msgs/String on /storm0, /storm1, ...), ~rate [messages a
// second, all together], ~burst (so many at a time), ~values (of the messages: value0, value1,
// ..., in turn; 0: all are alike), ~seconds (then it ends; 0: never).

#include <ros/ros.h>
#include <std_msgs/String.h>

#include <string>
#include <vector>

int main(int argc, char** argv) {
  ros::init(argc, argv, "storm", ros::init_options::NoRosout);
  ros::NodeHandle node_handle;
  const ros::NodeHandle parameters("~");
  std::vector<ros::Publisher> publishers;
  for (int i = 0; i < parameters.param("topics", 1); ++i) {
    publishers.push_back(
        node_handle.advertise<std_msgs::String>("/storm" + std::to_string(i), 10000));
  }
  const int rate = parameters.param("rate", 100);
  const int burst = parameters.param("burst", 1);
  const int values = parameters.param("values", 0);
  const double seconds = parameters.param("seconds", 0.0);
  std_msgs::String message;
  const ros::SteadyTime start = ros::SteadyTime::now();
  std::int64_t sent = 0;
  for (double now = 0; ros::ok() && (seconds == 0 || now < seconds);
       now = (ros::SteadyTime::now() - start).toSec()) {
    while (sent + burst <= static_cast<std::int64_t>(now * rate)) {
      for (const std::int64_t end = sent + burst; sent < end; ++sent) {
        if (values > 0) {
          message.data = "value" + std::to_string(sent % values);
        }
        publishers[static_cast<std::size_t>(sent) % publishers.size()].publish(message);
      }
    }
    ros::WallDuration(0.001).sleep();
  }
}
