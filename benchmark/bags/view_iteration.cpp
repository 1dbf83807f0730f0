// Iterates over a bag with rosbag alone and looks at the time and the topic of every message:
// every program that uses rosbag::View must do this. Without a bag it does nothing: this measures
// how long a process takes to start.

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <cstdint>
#include <iostream>

int main(int argc, char** argv) {
  if (argc < 2) {
    return 0;
  }
  rosbag::Bag bag(argv[1], rosbag::bagmode::Read);
  std::uint64_t messages = 0;
  std::uint64_t seen = 0;  // used, so that the compiler keeps the loop
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    seen += message.getTime().toNSec() + message.getTopic().size();
    ++messages;
  }
  std::cout << messages << ' ' << seen << '\n';
}
