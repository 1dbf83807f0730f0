#include "open_bag.h"

#include <rosbag/exceptions.h>

#include <boost/filesystem/operations.hpp>
#include <fstream>
#include <new>
#include <stdexcept>

#include "bag_records.h"
#include "self_awareness/ros/bag/bag_reader.h"

namespace self_awareness::ros1 {
namespace {

bool startsLikeABag(const std::string& path) {
  constexpr char kMagic[] = "#ROSBAG V";
  char start[sizeof kMagic] = {};
  std::ifstream(path, std::ios::binary).read(start, sizeof start - 1);
  return std::string(start) == kMagic;
}

}  // namespace

std::string reindexHint(const std::string& path) {
  return "; mend it with: rosbag reindex '" + path + "', or leave it out";
}

BagIndex openBag(const std::string& path, const ChunkProgress& progress) {
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
  if (!startsLikeABag(path)) {
    throw BagError(path + ": not a bag of ROS 1");
  }
  try {
    return readBagIndex(path, progress);
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

}  // namespace self_awareness::ros1
