// Load for the benchmark of the live monitor: publishes on many topics at exact rates.
//
// load PREFIX TOPICS RATE SEED [IMAGE]
//   PREFIX  topics are PREFIX0, PREFIX1, ...
//   TOPICS  how many; sensor_msgs/Imu, 318 bytes of content
//   RATE    of each [Hz]: one timer, whose periods vary by 2 %, starts a cycle in which all are
//           published one after the other, at distances that vary by 50 %
//   IMAGE   a further topic with sensor_msgs/Image at 30 Hz, by a timer of its own
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
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kJitter = 0.02;     // of a period, up or down
constexpr double kStepJitter = 0.5;  // of the distances in a cycle
constexpr double kBusy = 0.9;        // share of a period that a cycle takes
constexpr double kImageRate = 30;    // [Hz]
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
    std::uniform_real_distribution<double> phase(0, 1);
    sensor_msgs::Image image;
    image.data.resize(image_bytes);
    const bool images = image_publisher_ && image_bytes > 0;
    double next_image = phase(random_) / kImageRate;
    std::uint64_t published = 0;
    start_ = Clock::now();
    for (double cycle = phase(random_) / rate_; cycle < seconds;
         cycle += jittered(1 / rate_, kJitter)) {
      double due = cycle;
      for (const ros::Publisher& publisher : publishers_) {
        for (; images && next_image < due; next_image += jittered(1 / kImageRate, kJitter)) {
          sleepUntil(next_image);
          image.header.stamp = ros::Time::now();
          image_publisher_.publish(image);
          ++published;
        }
        sleepUntil(due);
        imu_.header.stamp = ros::Time::now();
        publisher.publish(imu_);
        ++published;
        due += jittered(kBusy / rate_ / static_cast<double>(publishers_.size()), kStepJitter);
      }
    }
    return published;
  }

 private:
  /// Varies a time [s].
  double jittered(double time, double jitter) {
    return time * std::uniform_real_distribution<double>(1 - jitter, 1 + jitter)(random_);
  }
  void sleepUntil(double time) const {
    std::this_thread::sleep_until(
        start_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time)));
  }

  ros::NodeHandle node_handle_;
  std::vector<ros::Publisher> publishers_;
  ros::Publisher image_publisher_;
  sensor_msgs::Imu imu_;
  double rate_;
  std::mt19937 random_;
  Clock::time_point start_;
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
