// Iterates a bag with rosbag alone and looks at the time and the topic of every message: what no
// program that uses rosbag::View can do without. Without a bag it does nothing, for the time that
// a process needs to start.

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
  std::uint64_t seen = 0;  // what is looked at must be used
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    seen += message.getTime().toNSec() + message.getTopic().size();
    ++messages;
  }
  std::cout << messages << ' ' << seen << '\n';
}
