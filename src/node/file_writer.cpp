#include "file_writer.h"

#include <ros/console.h>

#include <exception>
#include <utility>

namespace self_awareness {

constexpr std::chrono::hours kAnyTime(1);  // to wait for what notifies

FileWriter::FileWriter(double pause) : pause_(pause), thread_([this] { run(); }) {}

void FileWriter::finish() {
  shared_.lock()->stopping = true;
  changed_.notify_one();
  if (thread_.joinable()) {
    thread_.join();
  }
}

void FileWriter::add(File file) {
  {
    const auto shared = shared_.lock();
    if (shared->waiting.size() == kMostWaiting) {
      giveUp(*shared, shared->waiting.front());
      shared->waiting.pop_front();
    }
    shared->report.waiting_bytes += file.bytes;
    shared->waiting.push_back(std::move(file));
  }
  changed_.notify_one();
}

void FileWriter::run() {
  while (std::optional<File> file = next()) {
    std::string error;
    try {
      file->write(file->path);
    } catch (const std::exception& problem) {
      error = problem.what();
    }
    onAttempt(std::move(*file), error);
  }
}

std::optional<FileWriter::File> FileWriter::next() {
  auto shared = shared_.lock();
  if (shared->failed) {
    shared.waitFor(changed_, pause_, [](const Shared& data) { return data.stopping; });
    shared->failed = false;
  }
  while (shared->waiting.empty() && !shared->stopping) {
    shared.waitFor(changed_, kAnyTime,
                   [](const Shared& data) { return data.stopping || !data.waiting.empty(); });
  }
  if (shared->waiting.empty()) {
    return std::nullopt;
  }
  File file = std::move(shared->waiting.front());
  shared->waiting.pop_front();
  return file;
}

// The log is written without the lock: it may wait for the console.
void FileWriter::onAttempt(File file, const std::string& error) {
  const std::string path = file.path;
  if (error.empty()) {
    const auto shared = shared_.lock();
    shared->report.error.clear();
    shared->report.last_written = path;
    ++shared->report.written;
    shared->report.waiting_bytes -= file.bytes;
  }
  if (error.empty()) {
    ROS_INFO("%s is written", path.c_str());
  } else if (!keepForLater(std::move(file), error)) {
    ROS_ERROR("%s is given up: %s", path.c_str(), error.c_str());
  } else if (error != warned_) {  // not with every attempt
    ROS_WARN("%s is not written yet: %s", path.c_str(), error.c_str());
  }
  warned_ = error;
}

bool FileWriter::keepForLater(File file, const std::string& error) {
  const auto shared = shared_.lock();
  shared->report.error = error;
  if (shared->stopping || shared->waiting.size() == kMostWaiting) {
    giveUp(*shared, file);
    return false;
  }
  shared->failed = true;
  shared->waiting.push_front(std::move(file));
  return true;
}

void FileWriter::giveUp(Shared& shared, const File& file) {
  ++shared.report.given_up;
  shared.report.waiting_bytes -= file.bytes;
}

}  // namespace self_awareness
