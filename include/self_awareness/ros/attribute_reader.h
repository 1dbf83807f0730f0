#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "self_awareness/core/stream/attributes.h"
#include "self_awareness/ros/encoding.h"

namespace self_awareness::ros1 {

/// Reads the attributes of the messages of one connection, in their order, while their bytes pass:
/// nothing of them is kept but a sample (docs/method.md, section 3.10).
class AttributeReader {
 public:
  /// Whether bytes are those of the last message is known by so many blocks of so many bytes at
  /// most, spread over the message behind its header.
  static constexpr std::uint64_t kBlocks = 8;
  static constexpr std::uint64_t kBlock = 512;  ///< [bytes]
  /// What an array of any length begins with [bytes].
  static constexpr std::size_t kLengthOfArray = 4;

  /// @param connection messages whose definition does not begin with a std_msgs/Header, or with an
  /// array of something that does (tf2_msgs/TFMessage), are without one. In an array, that of the
  /// first element tells the age, but no number, and is compared as content. Of rosgraph_msgs/Log,
  /// nothing is known: its lines are for people, of any length, and the same one may come again
  /// and again. A latching publisher of rospy also numbers the copies that new subscribers get:
  /// its numbers say nothing of losses.
  explicit AttributeReader(const Connection& connection);

  /// Begins a message.
  /// @param size of the whole message [bytes]
  void begin(std::uint64_t size);
  /// Takes in the next bytes of the message.
  void add(const std::uint8_t* data, std::size_t size);
  /// A part of the message [bytes from its begin].
  struct Part {
    std::uint64_t begin = 0;
    std::uint64_t end = 0;
  };
  /// The next bytes that matter; empty at the end. What lies before them may be skipped.
  Part next() const;
  /// Goes on with the bytes of a place, which lies before the end of next().
  void skipTo(std::uint64_t place) { position_ = place; }
  /// Ends the message.
  /// @param now when it came, by the clock that stamps are of [ns]
  core::Attributes end(std::int64_t now);
  /// A message that is not read: its bytes are taken to repeat those of the one before as that one
  /// did, its age is not known, and its number goes on.
  /// @param size of the whole message [bytes]
  core::Attributes skip(std::uint64_t size);

  bool hasHeader() const { return place_.has_value(); }
  /// The number of the last message (header.seq); none: it has none.
  std::optional<std::uint32_t> number() const { return last_number_; }

 private:
  static constexpr std::size_t kHeader =
      16;  // header.seq, header.stamp and the length of frame_id

  /// Calls the function with each part of the message that is compared with that of the one
  /// before.
  template <typename Function>
  void forEachSample(Function function) const;
  void sample(const std::uint8_t* data, std::uint64_t size);
  std::uint32_t numberAt(std::size_t place) const;
  void readHeader(std::int64_t now, core::Attributes& attributes);

  /// Whether messages begin with their header.
  bool isFirst() const { return place_ == std::size_t{0}; }

  std::optional<std::size_t> place_;  // of the header [bytes]; none: there is none
  std::size_t header_end_ = 0;        // of its part that is read [bytes]
  bool is_read_ = true;
  bool is_numbered_ = true;
  std::uint64_t size_ = 0;      // of the message [bytes]
  std::uint64_t position_ = 0;  // in it [bytes]
  std::uint64_t content_ = 0;   // where its header has ended [bytes]
  std::array<std::uint8_t, kLengthOfArray + kHeader> header_{};
  std::vector<std::uint8_t> sample_;
  // Of the message before:
  std::optional<std::uint64_t> last_content_;  // behind its header [bytes]; none: there was none
  std::vector<std::uint8_t> last_sample_;
  std::optional<std::uint32_t> last_number_;
  bool last_same_ = false;
};

}  // namespace self_awareness::ros1
