#include "open_bag.h"

#include <rosbag/exceptions.h>

#include <algorithm>
#include <boost/filesystem/operations.hpp>
#include <cerrno>
#include <fstream>
#include <new>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "bag_records.h"
#include "self_awareness/ros/bag/bag_reader.h"

namespace self_awareness::ros1 {
namespace {

/// How files of other formats begin, and what to do with them.
const std::vector<std::pair<std::string, std::string>> kForeign{
    {{"SQLite format 3\0", 16},
     "a recording of ROS 2 (SQLite); rosbags-convert (pip install rosbags) makes a bag of it, "
     "but it does not say who sent what"},
    {"#ROSBAG V",
     "of the format before 2010; write it anew with: rosbag filter OLD.bag NEW.bag True"},
    {"\x1f\x8b", "compressed by gzip; unpack it first (gunzip)"},
    {"BZh", "compressed by bzip2; unpack it first (bunzip2)"},
    {{"\xfd"
      "7zXZ\0",
      6},
     "compressed by xz; unpack it first (unxz)"},
    {"\x28\xb5\x2f\xfd", "compressed by zstd; unpack it first (unzstd)"},
    {"\x04\x22\x4d\x18", "compressed by lz4; unpack it first (unlz4)"},
    {"7z\xbc\xaf\x27\x1c", "a 7z archive; unpack it first (7z x)"},
    {"PK\x03\x04", "a zip archive; unpack it first (unzip)"}};

bool startsWith(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

/// Why a file that begins so is no bag of ROS 1; empty: it may be one.
std::string whyNoBag(const std::string& start) {
  if (startsWith(start, "#ROSBAG V2.")) {
    return "";
  }
  if (start.empty()) {
    return "the file is empty";
  }
  // After the magic bytes a record of the file's header: its kind, its length, and in it the
  // length of the profile, and the profile.
  if (startsWith(start, "\x89MCAP")) {
    return startsWith(start.substr(std::min<std::size_t>(start.size(), 21)), "ros2")
               ? "MCAP of ROS 2; rosbags-convert (pip install rosbags) makes a bag of it, but it "
                 "does not say who sent what"
               : "MCAP; make a bag of it with mcap_to_bag.py (pip install mcap), which is in the "
                 "folder examples of this package";
  }
  for (const auto& [magic, what] : kForeign) {
    if (startsWith(start, magic)) {
      return what;
    }
  }
  return "of no format that is known here";
}

std::string startOf(const std::string& path) {
  std::string start(32, '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw BagError(path + ": cannot be read (" + std::generic_category().message(errno) + ")");
  }
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(file.gcount()));
  return start;
}

/// Calls a function that reads a file as a bag.
/// @throw BagError for all that may be wrong with the file
template <typename Read>
auto readBag(const std::string& path, const Read& read) {
  boost::system::error_code error;
  const boost::filesystem::file_status status = boost::filesystem::status(path, error);
  if (status.type() == boost::filesystem::file_not_found) {
    throw BagError(path + ": no such file");
  }
  if (status.type() == boost::filesystem::status_error) {
    throw BagError(path + ": cannot be read (" + error.message() + ")");
  }
  if (!boost::filesystem::is_regular_file(status)) {
    throw BagError(path + ": not a file; name a bag");
  }
  const std::string problem = whyNoBag(startOf(path));
  if (!problem.empty()) {
    throw BagError(path + ": not a bag of ROS 1: " + problem);
  }
  try {
    return read();
  } catch (const bag_records::EncryptedError&) {
    throw BagError(path +
                   ": the bag is encrypted; write it again without: rosbag encrypt --plugin "
                   "rosbag/NoEncryptor '" +
                   path + "'");
  } catch (const rosbag::BagUnindexedException&) {
    throw BagError(path + ": the bag has no index, its recording was not ended properly" +
                   reindexHint(path));
  } catch (const rosbag::BagException& error) {
    throw BagError(path + ": the bag is truncated or damaged (" + error.what() + ")" +
                   reindexHint(path));
  } catch (const std::bad_alloc&) {  // damaged numbers ask for much memory
    throw BagError(path + ": the bag is damaged, or there is too little memory" +
                   reindexHint(path));
  } catch (const std::length_error&) {
    throw BagError(path + ": the bag is damaged" + reindexHint(path));
  }
}

}  // namespace

std::string reindexHint(const std::string& path) {
  return "; mend it with: rosbag reindex '" + path + "', or leave it out";
}

BagIndex openBag(const std::string& path, const ChunkProgress& progress) {
  return readBag(path, [&] { return readBagIndex(path, true, progress); });
}

BagSpan spanOfBag(const std::string& path) {
  return readBag(path, [&] { return readBagSpan(path); });
}

}  // namespace self_awareness::ros1
