#pragma once

#include <ros/time.h>
#include <rosbag/exceptions.h>

#include <algorithm>
#include <boost/filesystem/operations.hpp>
#include <cstdint>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>

#include "../bag/bag_index.h"
#include "../bag/stored_messages.h"
#include "../bag/version_of_bag.h"
#include "../check.h"
#include "self_awareness/ros/bag/bag_reader.h"
#include "self_awareness/ros/bag/bag_writer.h"
#include "self_awareness/ros/file_version.h"
#include "self_awareness/ros/output_file.h"

namespace self_awareness::ros1 {

/// A file that holds one message, for another start of the monitor.
struct OneMessageFile {
  FileKind kind;
  const char* topic;
  const char* damaged;       ///< what is said of a file that cannot be read
  std::uint64_t most_bytes;  ///< a larger one is not read
};

/// Writes the whole file or nothing (see OutputFile).
/// @throw FileError or BagError if it cannot be written
template <typename Message>
void writeOneMessage(const OneMessageFile& of, const Message& message, const ros::Time& stamp,
                     const std::string& path) {
  OutputFile file(path);
  BagWriter bag(file.temporary(), BagWriter::Chunks::kOfOneMessage, path);
  const ros::Time at = std::max(stamp, ros::TIME_MIN);
  bag.write({kVersionTopic}, at, versionOf(of.kind));
  bag.write({of.topic}, at, message);
  bag.close();
  file.complete();
}

/// @param checkContent throws std::invalid_argument if the content cannot be
/// @return none: there is no file
/// @throw BagError if it is damaged, or no such file; names it
template <typename Message, typename Check>
std::optional<Message> readOneMessage(const OneMessageFile& of, const std::string& path,
                                      const Check& checkContent) {
  const auto damaged = [&](const std::string& why) {
    return BagError(path + ": " + of.damaged + why);
  };
  boost::system::error_code error;
  if (!boost::filesystem::exists(path, error)) {
    return std::nullopt;
  }
  try {
    // To open a pipe would wait for its writer.
    check(boost::filesystem::is_regular_file(path, error) &&
              boost::filesystem::file_size(path, error) <= of.most_bytes,
          "it is no such file");
    const BagIndex index = readBagIndex(path);
    checkedVersion(path, index, of.kind);
    StoredMessages messages(path, index, of.most_bytes);
    std::optional<Message> found;
    for (const BagIndexEntry& entry : index.entries) {
      if (holds<Message>(index.connections[entry.connection])) {
        check(!found, "it holds several of them");
        found = messages.read<Message>(entry);
      }
    }
    check(found.has_value(), "it holds none");
    checkContent(*found);
    return found;
  } catch (const rosbag::BagException& problem) {
    throw damaged(std::string(" (") + problem.what() + ")");
  } catch (const std::invalid_argument& problem) {
    throw damaged(std::string(" (") + problem.what() + ")");
  } catch (const std::bad_alloc&) {
    throw damaged("");
  }
}

}  // namespace self_awareness::ros1
