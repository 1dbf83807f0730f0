#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>

namespace self_awareness::fuzz {

/// The input of a fuzzer as a file, in memory: the readers take the names of files.
class FuzzedFile {
 public:
  FuzzedFile(const std::uint8_t* data, std::size_t size) : file_(::memfd_create("fuzzed", 0)) {
    if (file_ < 0 || ::write(file_, data, size) != static_cast<ssize_t>(size)) {
      std::abort();
    }
  }
  ~FuzzedFile() { ::close(file_); }
  FuzzedFile(const FuzzedFile&) = delete;
  FuzzedFile& operator=(const FuzzedFile&) = delete;

  std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

 private:
  int file_;
};

}  // namespace self_awareness::fuzz
