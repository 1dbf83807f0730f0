#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <thread>

#include "self_awareness/ros/guarded.h"

namespace self_awareness {

/// Writes files one after the other in a thread of its own: a disk may be slow. A file that cannot
/// be written, as on a full or read-only disk, is tried again, and a few others wait meanwhile.
class FileWriter {
 public:
  /// Files that may wait, besides the one that is being written; then the oldest is given up.
  static constexpr std::size_t kMostWaiting = 2;
  static constexpr double kPause = 5;  ///< between two attempts to write a file [s]

  struct File {
    std::string path;
    std::size_t bytes = 0;  ///< of memory that it keeps until it is written
    /// Writes it whole or not at all; called in the writer's thread.
    /// @throw std::exception if it cannot be written
    std::function<void(const std::string& path)> write;
  };
  struct Report {
    std::string error;              ///< why the last attempt failed; empty: it did not
    std::string last_written;       ///< path; empty: none yet
    std::uint64_t written = 0;      ///< files
    std::uint64_t given_up = 0;     ///< files
    std::size_t waiting_bytes = 0;  ///< memory of files that are not yet written
  };

  explicit FileWriter(double pause = kPause);
  ~FileWriter() { finish(); }

  /// Writes the file soon; does not wait for the disk.
  void add(File file);
  /// Tries to write what waits once more, and waits for it. Nothing is written after it.
  void finish();
  Report report() const { return shared_.lock()->report; }

 private:
  struct Shared {
    std::deque<File> waiting;
    Report report;
    bool failed = false;  // the first of those that wait: it has to pause
    bool stopping = false;
  };

  void run();
  /// Waits for the next file to write; none: the thread must end.
  std::optional<File> next();
  /// @param error why it failed; empty: it did not
  void onAttempt(File file, const std::string& error);
  /// @return whether it is tried again; else it is given up
  bool keepForLater(File file, const std::string& error);
  static void giveUp(Shared& shared, const File& file);

  const std::chrono::duration<double> pause_;
  ros1::Guarded<Shared> shared_;
  std::condition_variable changed_;
  std::string warned_;  // error of the last attempt; the thread's own
  std::thread thread_;  // last: it uses the others
};

}  // namespace self_awareness
