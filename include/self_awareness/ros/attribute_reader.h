#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "self_awareness/core/stream/attributes.h"
#include "self_awareness/ros/encoding.h"

namespace self_awareness::ros1 {

/// Reads the attributes of the messages of one connection, in their order:
/// nothing of them is kept but a sample (docs/method.md, section 3.10).
class AttributeReader {
 public:
  /// Whether bytes are those of the last message is known by so many blocks of so many bytes at
  /// most, spread over the message behind its header.
  static constexpr std::uint64_t kBlocks = 8;
  static constexpr std::uint64_t kBlock = 512;  ///< [bytes]
  /// What an array of any length begins with [bytes].
  static constexpr std::size_t kLengthOfArray = 4;

  /// Bytes of a message, from one place to another one; valid until the next call.
  using Bytes = std::function<std::string_view(std::uint64_t from, std::uint64_t to)>;

  /// @param connection messages whose definition does not begin with a std_msgs/Header, or with an
  /// array of something that does (tf2_msgs/TFMessage), are without one. In an array, that of the
  /// first element tells the age, but no number, and is compared as content. Of rosgraph_msgs/Log,
  /// nothing is known: its lines are for people, of any length, and the same one may come again
  /// and again. A latching publisher of rospy also numbers the copies that new subscribers get:
  /// its numbers say nothing of losses.
  explicit AttributeReader(const Connection& connection);

  /// Takes in the next message. Of a long one, only the bytes that matter are asked for.
  /// @param size of the whole message [bytes]
  /// @param now when it came, by the clock that stamps are of [ns]
  core::Attributes read(std::uint64_t size, const Bytes& bytes, std::int64_t now);
  /// The same of a message in memory.
  core::Attributes read(const std::vector<std::uint8_t>& content, std::int64_t now);
  /// A message that is not read: its bytes are taken to repeat those of the one before as that one
  /// did, its age is not known, and its number goes on.
  /// @param size of the whole message [bytes]
  core::Attributes skip(std::uint64_t size);

  /// The number of the last message (header.seq); none: it has none.
  std::optional<std::uint32_t> number() const { return last_number_; }

 private:
  // header.seq, header.stamp and the length of frame_id [bytes]
  static constexpr std::size_t kHeader = 16;

  /// What is read of the header, behind the length of its array, if it lies in one.
  using Head = std::array<char, kLengthOfArray + kHeader>;

  /// Takes over the parts of the message that are compared with those of the one before.
  /// @param begin of its content [bytes]
  void sample(std::uint64_t begin, std::uint64_t size, const Bytes& bytes);
  void readHeader(const Head& head, std::int64_t now, core::Attributes& attributes);
  /// Whether messages begin with their header.
  bool isFirst() const { return place_ == std::size_t{0}; }

  std::optional<std::size_t> place_;  // of the header [bytes]; none: there is none
  bool is_read_ = true;
  bool is_numbered_ = true;
  std::string sample_;
  // Of the message before:
  std::optional<std::uint64_t> last_content_;  // behind its header [bytes]; none: there was none
  std::string last_sample_;
  std::optional<std::uint32_t> last_number_;
  bool last_same_ = false;
};

}  // namespace self_awareness::ros1
