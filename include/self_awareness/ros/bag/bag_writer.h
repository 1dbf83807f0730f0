#pragma once

#include <ros/serialization.h>
#include <ros/time.h>

#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace self_awareness::ros1 {

/// Writes a bag, message by message. Each message is in the file when the call returns: of a bag
/// that was not closed, `rosbag reindex` saves all of them.
///
/// rosbag's writer keeps a chunk in memory, and ends the program if the disk is full: its
/// destructor throws.
class BagWriter {
 public:
  /// Replaces a file that is there.
  /// @throw BagError if it cannot be written
  explicit BagWriter(std::string path);
  /// A bag that was not closed stays as it is.
  ~BagWriter();
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  /// @param stamp of the message in the bag, not 0
  /// @throw BagError if the disk is full, or another error; the bag is of no use then
  template <typename Message>
  void write(const std::string& topic, const ros::Time& stamp, const Message& message) {
    content_.resize(ros::serialization::serializationLength(message));
    ros::serialization::OStream stream(content_.data(),
                                       static_cast<std::uint32_t>(content_.size()));
    ros::serialization::serialize(stream, message);
    namespace traits = ros::message_traits;
    write(stamp, {topic, traits::datatype<Message>(), traits::md5sum<Message>(),
                  traits::definition<Message>()});
  }
  /// Writes the index.
  /// @throw BagError as write()
  void close();

  const std::string& path() const { return path_; }
  /// Size of the file so far [bytes].
  std::uint64_t size() const { return size_; }

 private:
  struct Connection {
    std::string topic;
    std::string datatype;
    std::string md5sum;
    std::string definition;
  };
  struct Chunk {
    std::uint64_t position = 0;  // [bytes]
    ros::Time stamp;             // of its message
    std::uint32_t connection = 0;
  };
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  /// Writes content_.
  void write(const ros::Time& stamp, const Connection& connection);
  /// The record of a connection.
  static std::string record(std::uint32_t number, const Connection& connection);
  void writeFileHeader(std::uint64_t index);
  void append(const std::string& bytes);
  [[noreturn]] void fail() const;

  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::uint64_t size_ = 0;
  std::map<std::string, std::uint32_t> numbers_;  // of connections, by topic
  std::vector<Connection> connections_;
  std::vector<Chunk> chunks_;
  std::vector<std::uint8_t> content_;
};

}  // namespace self_awareness::ros1
