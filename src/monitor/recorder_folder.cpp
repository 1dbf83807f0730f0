#include "recorder_folder.h"

#include <algorithm>
#include <boost/filesystem.hpp>
#include <cstdio>
#include <cstdlib>
#include <regex>
#include <stdexcept>
#include <vector>

#include "self_awareness/core/stream/event.h"

namespace self_awareness {
namespace {

namespace filesystem = boost::filesystem;

constexpr char kRosHome[] = "$ROS_HOME/";
constexpr char kName[] = "$NAME";

std::string inHomeFolder(const std::string& path) {
  const char* home = std::getenv("HOME");
  return path.rfind("~/", 0) == 0 && home != nullptr ? home + path.substr(1) : path;
}

std::string asFileName(std::string name) {
  name = name.substr(std::min(name.find_first_not_of('/'), name.size()));
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

/// @param name of the monitor, as asFileName() has it
std::string written(std::string path, const std::string& name) {
  if (path.rfind(kRosHome, 0) == 0) {
    const char* ros_home = std::getenv("ROS_HOME");
    path = (ros_home != nullptr && *ros_home != '\0' ? std::string(ros_home) : "~/.ros") +
           path.substr(sizeof kRosHome - 2);
  }
  for (std::size_t at = path.find(kName); at != std::string::npos; at = path.find(kName, at)) {
    path.replace(at, sizeof kName - 1, name);
    at += name.size();
  }
  return inHomeFolder(path);
}

struct RecorderFile {
  std::string time;  // as in its name
  filesystem::path path;
  std::uint64_t bytes;
};

}  // namespace

RecorderFolder::RecorderFolder(const std::string& path, const std::string& name,
                               std::size_t most_files, std::uint64_t most_bytes)
    : name_(asFileName(name)),
      path_(filesystem::absolute(written(path, name_)).string()),
      most_files_(most_files),
      most_bytes_(most_bytes) {}

std::string RecorderFolder::pathOf(const std::string& cause, std::int64_t wall_time) const {
  boost::system::error_code error;
  std::string path;
  do {
    path = path_ + "/" + cause + "_" + timeInFileName(wall_time) + ".bag";
    wall_time += kNameStep;
  } while (filesystem::exists(path, error));
  return path;
}

std::string timeInFileName(std::int64_t wall_time) {
  char milliseconds[8];
  std::snprintf(milliseconds, sizeof milliseconds, ".%03d",
                static_cast<int>(wall_time % core::kNanosecondsPerSecond / kNameStep));
  return core::inUtc(wall_time, "%Y-%m-%d-%H-%M-%S") + milliseconds;
}

void RecorderFolder::create() const {
  boost::system::error_code error;
  if (filesystem::exists(path_, error) && !filesystem::is_directory(path_)) {
    throw std::runtime_error(path_ + ": is no folder for the flight recorder, but a file");
  }
  filesystem::create_directories(path_, error);
  if (error) {
    throw std::runtime_error(path_ + ": the flight recorder cannot create this folder (" +
                             error.message() + ")");
  }
}

void RecorderFolder::makeRoom(const std::string& kept) const {
  removeOldest(path_, "(?:alarm|dump|shutdown)_([-0-9.]+)\\.bag", most_files_, most_bytes_, kept);
}

void removeOldest(const std::string& folder, const std::string& names, std::size_t most_files,
                  std::uint64_t most_bytes, const std::string& kept) {
  const std::regex pattern(names);
  std::vector<RecorderFile> files;
  std::uint64_t bytes = 0;
  for (const filesystem::directory_entry& entry : filesystem::directory_iterator(folder)) {
    std::smatch match;
    const std::string name = entry.path().filename().string();
    if (std::regex_match(name, match, pattern) && filesystem::is_regular_file(entry.path())) {
      files.push_back({match[1], entry.path(), filesystem::file_size(entry.path())});
      bytes += files.back().bytes;
    }
  }
  std::sort(files.begin(), files.end(),
            [](const RecorderFile& a, const RecorderFile& b) { return a.time < b.time; });
  std::size_t left = files.size();
  for (std::size_t i = 0; i + 1 < files.size() && (left > most_files || bytes > most_bytes); ++i) {
    if (files[i].path.string() != kept) {
      filesystem::remove(files[i].path);
      --left;
      bytes -= files[i].bytes;
    }
  }
}

}  // namespace self_awareness
