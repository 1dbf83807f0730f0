// Load for the benchmark of the live monitor: publishes on many topics at exact rates.
//
// load PREFIX TOPICS RATE SEED [IMAGE]
//   PREFIX  topics are PREFIX0, PREFIX1, ...
//   TOPICS  how many; sensor_msgs/Imu, 318 bytes of content
//   RATE    of each [Hz]; periods vary by 2 %
//   IMAGE   a further topic with sensor_msgs/Image at 30 Hz
//
// Commands, one a line, from standard input, each answered by a line:
//   await N                subscribers of every topic
//   publish SECONDS BYTES  and so many bytes an image; 0: no images. Answers with the number of
//                          published messages.

#include <ros/ros.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <iostream>
#include <queue>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kJitter = 0.02;   // of a period, either way
constexpr double kImageRate = 30;  // [Hz]
constexpr std::uint32_t kQueueSize = 1000;
constexpr std::uint32_t kImageQueueSize = 10;

class Load {
 public:
  Load(const std::string& prefix, int topics, double rate, unsigned seed, const std::string& image)
      : rate_(rate), random_(seed) {
    for (int i = 0; i < topics; ++i) {
      publishers_.push_back(
          node_handle_.advertise<sensor_msgs::Imu>(prefix + std::to_string(i), kQueueSize));
    }
    if (!image.empty()) {
      image_publisher_ = node_handle_.advertise<sensor_msgs::Image>(image, kImageQueueSize);
    }
    imu_.header.frame_id = "imu";
  }

  void await(std::uint32_t subscribers) const {
    const auto heard = [subscribers](const ros::Publisher& publisher) {
      return publisher.getNumSubscribers() >= subscribers;
    };
    while (ros::ok() && !(std::all_of(publishers_.begin(), publishers_.end(), heard) &&
                          (!image_publisher_ || heard(image_publisher_)))) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }

  std::uint64_t publish(double seconds, std::size_t image_bytes) {
    struct Due {
      double at;          // [s]
      std::size_t topic;  // past the last one: the image
      bool operator<(const Due& other) const { return at > other.at; }
    };
    sensor_msgs::Image image;
    image.data.resize(image_bytes);
    std::uniform_real_distribution<double> phase(0, 1);
    std::uniform_real_distribution<double> jitter(1 - kJitter, 1 + kJitter);
    std::priority_queue<Due> next;
    for (std::size_t topic = 0; topic < publishers_.size(); ++topic) {
      next.push({phase(random_) / rate_, topic});
    }
    if (image_publisher_ && image_bytes > 0) {
      next.push({phase(random_) / kImageRate, publishers_.size()});
    }
    std::uint64_t published = 0;
    const Clock::time_point start = Clock::now();
    while (ros::ok() && next.top().at < seconds) {
      const Due due = next.top();
      next.pop();
      std::this_thread::sleep_until(start + std::chrono::duration_cast<Clock::duration>(
                                                std::chrono::duration<double>(due.at)));
      const bool is_image = due.topic == publishers_.size();
      if (is_image) {
        image.header.stamp = ros::Time::now();
        image_publisher_.publish(image);
      } else {
        imu_.header.stamp = ros::Time::now();
        publishers_[due.topic].publish(imu_);
      }
      ++published;
      next.push({due.at + jitter(random_) / (is_image ? kImageRate : rate_), due.topic});
    }
    return published;
  }

 private:
  ros::NodeHandle node_handle_;
  std::vector<ros::Publisher> publishers_;
  ros::Publisher image_publisher_;
  sensor_msgs::Imu imu_;
  double rate_;
  std::mt19937 random_;
};

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "load");
  if (argc < 5) {
    std::cerr << "load PREFIX TOPICS RATE SEED [IMAGE]\n";
    return 1;
  }
  Load load(argv[1], std::stoi(argv[2]), std::stod(argv[3]),
            static_cast<unsigned>(std::stoul(argv[4])), argc > 5 ? argv[5] : "");
  ros::AsyncSpinner spinner(1);
  spinner.start();
  std::string command;
  while (std::cin >> command) {
    if (command == "await") {
      std::uint32_t subscribers = 0;
      std::cin >> subscribers;
      load.await(subscribers);
      std::cout << "ready" << std::endl;
    } else if (command == "publish") {
      double seconds = 0;
      std::size_t image_bytes = 0;
      std::cin >> seconds >> image_bytes;
      std::cout << load.publish(seconds, image_bytes) << std::endl;
    } else {
      std::cerr << "unknown command: " << command << '\n';
      return 1;
    }
  }
  return 0;
}
