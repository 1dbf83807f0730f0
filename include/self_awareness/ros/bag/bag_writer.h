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

/// Writes a bag, message by message. One that was not closed stays as it is.
///
/// rosbag's writer ends the program if the disk is full: its destructor throws.
class BagWriter {
 public:
  /// How messages lie in the file.
  enum class Chunks {
    /// Each by itself. It is in the file when write() returns: of a bag that was not closed,
    /// `rosbag reindex` saves all messages.
    kOfOneMessage,
    /// Many together, compressed by LZ4.
    kCompressed
  };
  /// What a bag says of a topic, besides the type of its messages.
  struct Topic {
    std::string name;
    std::string callerid = "/self_awareness";
    bool latching = false;
    std::map<std::string, std::string> more = {};  ///< fields that readers need not know
  };

  /// Replaces a file that is there.
  /// @param named what errors call the file; empty: by its path
  /// @throw BagError if it cannot be written
  explicit BagWriter(std::string path, Chunks chunks = Chunks::kOfOneMessage,
                     std::string named = "");

  /// @param topic its first message says what the bag holds of it
  /// @param stamp of the message in the bag, not 0
  /// @throw BagError if the disk is full, or another error; the bag is of no use then
  template <typename Message>
  void write(const Topic& topic, const ros::Time& stamp, const Message& message) {
    content_.resize(ros::serialization::serializationLength(message));
    ros::serialization::OStream stream(content_.data(),
                                       static_cast<std::uint32_t>(content_.size()));
    ros::serialization::serialize(stream, message);
    namespace traits = ros::message_traits;
    write(stamp, topic,
          {traits::datatype<Message>(), traits::md5sum<Message>(), traits::definition<Message>()});
  }
  /// The message that was written last, as it lies in the file.
  const std::vector<std::uint8_t>& written() const { return content_; }
  /// Writes what is left, and the index.
  /// @throw BagError as write(), or if an earlier call has thrown
  void close();

  const std::string& path() const { return path_; }
  /// Size of the file so far [bytes].
  std::uint64_t size() const { return size_; }

 private:
  struct Type {
    std::string datatype;
    std::string md5sum;
    std::string definition;
  };
  struct Place {
    ros::Time stamp;           // of a message
    std::uint32_t offset = 0;  // in its chunk [bytes]
  };
  /// A chunk in the file.
  struct Chunk {
    std::uint64_t position = 0;  // [bytes]
    ros::Time first;             // stamps
    ros::Time last;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> counts;  // messages by connection
  };
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  /// Writes content_.
  void write(const ros::Time& stamp, const Topic& topic, const Type& type);
  /// Writes the messages that wait.
  void writeChunk();
  void writeFileHeader(std::uint64_t index);
  void append(const std::string& bytes);
  [[noreturn]] void fail();

  std::string path_;
  Chunks kind_;
  std::string named_;
  std::unique_ptr<std::FILE, Close> file_;  // none: it is closed, or could not be written
  std::uint64_t size_ = 0;
  std::map<std::string, std::uint32_t> numbers_;  // of connections, by topic
  std::vector<std::string> connections_;          // their records
  std::vector<Chunk> chunks_;
  std::string waiting_;                                 // data of the next chunk
  std::map<std::uint32_t, std::vector<Place>> places_;  // in it, by connection
  std::vector<std::uint8_t> content_;
};

}  // namespace self_awareness::ros1
