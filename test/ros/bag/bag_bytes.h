#pragma once

#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "../../files.h"

namespace self_awareness::ros1::bag_bytes {

/// Bags of format 2.0, byte by byte, so that a test can make what no program writes.

using self_awareness::readFile;
using self_awareness::writeFile;

template <typename Number>
std::string bytesOf(Number number) {
  return {reinterpret_cast<const char*>(&number), sizeof number};
}

inline std::string block(const std::string& bytes) {
  return bytesOf(static_cast<std::uint32_t>(bytes.size())) + bytes;
}

using Fields = std::initializer_list<std::pair<std::string, std::string>>;

inline std::string fields(const Fields& named) {
  std::string bytes;
  for (const auto& [name, value] : named) {
    bytes += block(name + "=" + value);
  }
  return bytes;
}

inline std::string record(const Fields& header, const std::string& data) {
  return block(fields(header)) + block(data);
}

/// Where the records of a file begin, and where the last one ends.
inline std::vector<std::size_t> boundaries(const std::string& file) {
  const auto length = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, &file[at], sizeof value);
    return value;
  };
  std::vector<std::size_t> begins{file.find('\n') + 1};
  while (begins.back() < file.size()) {
    const std::size_t data = begins.back() + sizeof(std::uint32_t) + length(begins.back());
    begins.push_back(data + sizeof(std::uint32_t) + length(data));
  }
  return begins;
}

/// A bag of one chunk with one connection, /a of /node, in pieces that a test may change.
struct Parts {
  std::string definition = "string data\n";
  std::string datatype = "std_msgs/String";
  std::string topic = "/a";
  std::string topic_of_data;  ///< of the connection, by its data; empty: the same
  std::string callerid = "/node";
  std::string compression = "none";
  std::vector<std::pair<std::uint32_t, std::string>> messages;  ///< second, and content
  std::uint32_t nanoseconds = 0;                                ///< of each time

  std::string chunk() const {
    std::string data;
    for (const auto& [second, content] : messages) {
      data += message(second, content);
    }
    return data;
  }
  std::string time(std::uint32_t second) const { return bytesOf(second) + bytesOf(nanoseconds); }
  std::string message(std::uint32_t second, const std::string& content) const {
    return record({{"op", "\x02"}, {"conn", bytesOf(std::uint32_t{0})}, {"time", time(second)}},
                  content);
  }
  std::string chunkRecord(const std::string& data, std::uint32_t unpacked) const {
    return record({{"op", "\x05"}, {"compression", compression}, {"size", bytesOf(unpacked)}},
                  data);
  }
  /// @param offset of the first message in its chunk
  std::string indexRecord(std::size_t offset = 0) const {
    std::string entries;
    for (const auto& [second, content] : messages) {
      entries += time(second) + bytesOf(static_cast<std::uint32_t>(offset));
      offset += message(second, content).size();
    }
    return record({{"op", "\x04"},
                   {"ver", bytesOf(std::uint32_t{1})},
                   {"conn", bytesOf(std::uint32_t{0})},
                   {"count", bytesOf(static_cast<std::uint32_t>(messages.size()))}},
                  entries);
  }
  std::string connectionRecord() const {
    return record({{"op", "\x07"}, {"conn", bytesOf(std::uint32_t{0})}, {"topic", topic}},
                  fields({{"callerid", callerid},
                          {"md5sum", "*"},
                          {"message_definition", definition},
                          {"topic", topic_of_data.empty() ? topic : topic_of_data},
                          {"type", datatype}}));
  }
  static std::string chunkInfo(std::uint64_t position, std::uint32_t messages) {
    const std::string no_time(8, '\0');
    return record({{"op", "\x06"},
                   {"ver", bytesOf(std::uint32_t{1})},
                   {"chunk_pos", bytesOf(position)},
                   {"start_time", no_time},
                   {"end_time", no_time},
                   {"count", bytesOf(std::uint32_t{1})}},
                  bytesOf(std::uint32_t{0}) + bytesOf(messages));
  }
  static std::string fileHeader(std::uint64_t index, std::uint32_t connections,
                                std::uint32_t chunks) {
    return "#ROSBAG V2.0\n" + record({{"op", "\x03"},
                                      {"index_pos", bytesOf(index)},
                                      {"conn_count", bytesOf(connections)},
                                      {"chunk_count", bytesOf(chunks)}},
                                     std::string(4027, ' '));
  }
  /// A chunk and its index.
  /// @param before the messages in the chunk
  std::string indexedChunk(const std::string& before = "") const {
    const std::string data = before + chunk();
    return chunkRecord(data, static_cast<std::uint32_t>(data.size())) + indexRecord(before.size());
  }
  /// @param chunks each with its index, one after the other
  /// @param connections at the end
  std::string bag(const std::vector<std::string>& chunks,
                  const std::vector<Parts>& connections) const {
    std::uint64_t position = fileHeader(0, 0, 0).size();
    std::string body;
    std::string end;
    for (const Parts& each : connections) {
      end += each.connectionRecord();
    }
    for (const std::string& chunk : chunks) {
      end += chunkInfo(position, static_cast<std::uint32_t>(messages.size()));
      body += chunk;
      position += chunk.size();
    }
    return fileHeader(position, static_cast<std::uint32_t>(connections.size()),
                      static_cast<std::uint32_t>(chunks.size())) +
           body + end;
  }
  std::string bag(const std::vector<std::string>& chunks) const { return bag(chunks, {*this}); }
  std::string bag() const { return bag({indexedChunk()}); }
};

}  // namespace self_awareness::ros1::bag_bytes
