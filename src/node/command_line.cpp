#include "command_line.h"

#include <cstdio>
#include <string_view>

#include "self_awareness/ros/file_version.h"

namespace self_awareness {

bool answered(int argc, char** argv, const std::string& usage) {
  const std::string_view asked = argc > 1 ? argv[1] : "";
  if (asked == "--version") {
    std::printf("self_awareness %s\n", ros1::kPackageVersion);
  } else if (asked == "--help" || asked == "-h") {
    std::printf("%s\n", usage.c_str());
  } else {
    return false;
  }
  return true;
}

}  // namespace self_awareness
