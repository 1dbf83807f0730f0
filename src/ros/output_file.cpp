#include "self_awareness/ros/output_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <boost/filesystem.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>

namespace self_awareness::ros1 {
namespace {

namespace fs = boost::filesystem;

constexpr char kPrefix[] = ".self_awareness_part";
constexpr std::size_t kLongestEndOfName = 200;  // with the prefix, file systems take 255 [bytes]
constexpr int kMostLinks = 40;                  // as the kernel follows
constexpr double kMegabyte = 1e6;

[[noreturn]] void fail(const std::string& path, int error, const std::string& temporary = "") {
  throw FileError(writeProblem(path, error, temporary));
}

fs::path folderOf(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// Where symbolic links lead, whether something is there or not.
fs::path followed(const std::string& name) {
  fs::path path = name;
  for (int links = 0; links < kMostLinks; ++links) {
    boost::system::error_code error;
    // What is written to the file would be mixed up with what the program writes to it already.
    if (fs::canonical(folderOf(path), error).string().rfind("/proc/", 0) == 0) {
      throw FileError(name + ": leads to a file that is open already; name that file itself");
    }
    if (fs::symlink_status(path, error).type() != fs::symlink_file) {
      return path;
    }
    const fs::path target = fs::read_symlink(path, error);
    if (error) {
      fail(name, error.value());
    }
    path = target.is_absolute() ? target : folderOf(path) / target;
  }
  fail(name, ELOOP);
}

void closeQuietly(int file) {
  static_cast<void>(::close(file));  // nothing was written by this descriptor
}

bool lock(int file, int how) {
  while (::flock(file, how) != 0) {
    if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

/// Whether a path still leads to the open file: it may have been removed since.
bool isAt(int file, const std::string& path) {
  struct stat open_file {};
  struct stat there {};
  return ::fstat(file, &open_file) == 0 && ::lstat(path.c_str(), &there) == 0 &&
         open_file.st_dev == there.st_dev && open_file.st_ino == there.st_ino;
}

/// Removes a temporary file if the program that wrote it has ended: its lock ended with it.
void removeIfLeft(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) {  // gone, or somebody else's
    return;
  }
  if (lock(file, LOCK_EX | LOCK_NB) && isAt(file, path)) {
    ::unlink(path.c_str());
  }
  closeQuietly(file);
}

void removeLeftovers(const fs::path& folder) {
  boost::system::error_code error;  // a folder that cannot be read may still be written to
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    if (entry->path().filename().string().rfind(kPrefix, 0) == 0) {
      removeIfLeft(entry->path().string());
    }
  }
}

void syncFolder(const fs::path& folder) {
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file >= 0) {
    // Not all file systems can do this. The file itself is whole in any case.
    static_cast<void>(::fsync(file));
    closeQuietly(file);
  }
}

}  // namespace

std::string writeProblem(const std::string& path, int error, const std::string& temporary) {
  std::string problem = path + ": cannot be written (" + std::strerror(error);
  const std::string& there = temporary.empty() ? path : temporary;
  boost::system::error_code unknown;
  const fs::space_info space = fs::space(folderOf(there), unknown);
  if (error == ENOSPC && !unknown && !fs::is_other(there, unknown)) {
    const std::uintmax_t written = temporary.empty() ? 0 : fs::file_size(temporary, unknown);
    char room[64];
    std::snprintf(room, sizeof room, ", there is room for %.1f MB",
                  static_cast<double>(space.available + (unknown ? 0 : written)) / kMegabyte);
    problem += room;
  }
  return problem + ")";
}

void checkFolder(const std::string& path) {
  const fs::path folder = fs::absolute(folderOf(path));
  if (boost::system::error_code error; !fs::is_directory(folder, error)) {
    throw FileError("there is no folder " + folder.string() + ": create it (mkdir -p '" +
                    folder.string() + "')");
  }
}

void putInPlace(const std::string& written, const std::string& path) {
  const int file = ::open(written.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) {
    fail(path, errno);
  }
  const int error = ::fsync(file) == 0 ? 0 : errno;
  closeQuietly(file);
  if (error != 0) {
    fail(path, error, written);
  }
  if (std::rename(written.c_str(), path.c_str()) != 0) {
    fail(path, errno, written);
  }
  syncFolder(folderOf(path));
}

OutputFile::OutputFile(const std::string& path) : path_(path), temporary_(path) {
  struct stat there {};
  const bool is_there = ::stat(path.c_str(), &there) == 0;
  if (is_there && S_ISDIR(there.st_mode)) {
    fail(path_, EISDIR);
  }
  if (is_there && !S_ISREG(there.st_mode)) {
    return;
  }
  if (is_there && ::access(path.c_str(), W_OK) != 0) {  // renaming would not ask
    fail(path_, errno);
  }
  target_ = followed(path).string();
  removeLeftovers(folderOf(target_));
  openTemporary();
  if (is_there) {  // not all file systems have permissions
    static_cast<void>(::fchmod(lock_, there.st_mode & 07777U));
  }
}

OutputFile::~OutputFile() {
  close();
}

void OutputFile::openTemporary() {
  const fs::path target = target_;
  const std::string name = target.filename().string();
  const std::string end = name.substr(name.size() - std::min(name.size(), kLongestEndOfName));
  for (int number = 0; lock_ < 0; ++number) {
    temporary_ = (folderOf(target) / (kPrefix + std::to_string(::getpid()) + "_" +
                                      std::to_string(number) + "." + end))
                     .string();
    const int file = ::open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0 && errno != EEXIST) {
      fail(path_, errno);
    }
    if (file >= 0) {
      // Some file systems know no locks: who clears up gets none there, either.
      lock(file, LOCK_EX);
      if (isAt(file, temporary_)) {
        lock_ = file;
      } else {  // it was cleared up before it was locked
        closeQuietly(file);
      }
    }
  }
}

void OutputFile::complete() {
  if (target_.empty()) {
    return;
  }
  try {
    putInPlace(temporary_, target_);
  } catch (const FileError&) {
    close();
    throw;
  }
  closeQuietly(lock_);
  lock_ = -1;
}

void OutputFile::close() {
  if (lock_ >= 0) {
    ::unlink(temporary_.c_str());
    closeQuietly(lock_);
    lock_ = -1;
  }
}

}  // namespace self_awareness::ros1
