#include "packed_events.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <unordered_map>

#include "self_awareness/ros/ros_time.h"

namespace self_awareness::ros1 {
namespace {

// A delay with more ones than this is stored whole, in kWholeBits.
constexpr std::uint64_t kMostOnes = 40;
constexpr int kWholeBits = 63;
constexpr int kMostDelayBits = 62;
constexpr int kMostIdBits = 32;
constexpr std::uint64_t kMostDelay = std::numeric_limits<std::int64_t>::max();  // [ns]

class BitWriter {
 public:
  explicit BitWriter(std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

  /// Writes the low bits of a value, the highest of them first.
  void write(std::uint64_t value, int bits) {
    for (int bit = bits - 1; bit >= 0; --bit) {
      if (free_ == 0) {
        bytes_.push_back(0);
        free_ = 8;
      }
      --free_;
      bytes_.back() |= static_cast<std::uint8_t>((value >> bit & 1) << free_);
    }
  }

 private:
  std::vector<std::uint8_t>& bytes_;
  int free_ = 0;  // bits of the last byte
};

class BitReader {
 public:
  explicit BitReader(const std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

  /// @param bits at most 63
  std::uint64_t read(std::size_t bits) {
    if (bits > 8 * bytes_.size() - position_) {
      throw std::invalid_argument("packed events are cut off");
    }
    std::uint64_t value = 0;
    while (bits > 0) {  // what is left of a byte at once
      const std::size_t left = 8 - position_ % 8;
      const std::size_t taken = std::min(left, bits);
      const unsigned byte = bytes_[position_ / 8];
      value = value << taken | (byte >> (left - taken) & ((1U << taken) - 1));
      position_ += taken;
      bits -= taken;
    }
    return value;
  }
  /// Bytes that were begun.
  std::size_t bytes() const { return (position_ + 7) / 8; }

 private:
  const std::vector<std::uint8_t>& bytes_;
  std::size_t position_ = 0;  // [bits]
};

std::uint64_t bitsOf(std::uint64_t delay, int delay_bits) {
  const std::uint64_t ones = delay >> delay_bits;
  return ones < kMostOnes ? ones + 1 + static_cast<std::uint64_t>(delay_bits)
                          : kMostOnes + kWholeBits;
}

constexpr int kClassBits = 8;  // of an age, and of a size
constexpr int kStepBits = 3;

/// The attributes of the last event of each type: what is new of the next one is stored.
using LastAttributes = std::unordered_map<core::EventId, core::Attributes>;

std::vector<std::uint8_t> packAttributes(const std::vector<core::Event>& events) {
  std::vector<std::uint8_t> bytes;
  if (std::none_of(events.begin(), events.end(),
                   [](const core::Event& event) { return event.attributes.isKnown(); })) {
    return bytes;
  }
  BitWriter writer(bytes);
  LastAttributes last;
  for (const core::Event& event : events) {
    const core::Attributes& now = event.attributes;
    core::Attributes& before = last[event.id];
    const bool as_last =
        now.size == before.size && now.step == before.step && now.same == before.same;
    writer.write(as_last ? 1 : 0, 1);
    if (!as_last) {
      writer.write(now.size, kClassBits);
      writer.write(static_cast<std::uint64_t>(now.step), kStepBits);
      writer.write(now.same ? 1 : 0, 1);
    }
    writer.write(now.age == before.age ? 1 : 0, 1);
    if (now.age != before.age) {
      writer.write(now.age, kClassBits);
    }
    before = now;
  }
  return bytes;
}

void unpackAttributes(const std::vector<std::uint8_t>& bytes, std::vector<core::Event>& events) {
  if (bytes.empty()) {
    return;
  }
  BitReader reader(bytes);
  LastAttributes last;
  for (core::Event& event : events) {
    core::Attributes& attributes = last[event.id];
    if (reader.read(1) == 0) {
      attributes.size = static_cast<std::uint8_t>(reader.read(kClassBits));
      attributes.step = static_cast<core::Attributes::Step>(reader.read(kStepBits));
      attributes.same = reader.read(1) == 1;
    }
    if (reader.read(1) == 0) {
      attributes.age = static_cast<std::uint8_t>(reader.read(kClassBits));
    }
    event.attributes = attributes;
  }
  if (reader.bytes() != bytes.size()) {
    throw std::invalid_argument("packed attributes are followed by other bytes");
  }
}

int shortestDelayBits(const std::vector<std::uint64_t>& delays) {
  int shortest = 0;
  std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
  for (int bits = 0; bits <= kMostDelayBits; ++bits) {
    std::uint64_t sum = 0;
    for (const std::uint64_t delay : delays) {
      sum += bitsOf(delay, bits);
    }
    if (sum < least) {
      least = sum;
      shortest = bits;
    }
  }
  return shortest;
}

}  // namespace

void pack(const std::vector<core::Event>& events, self_awareness::EventLog& part) {
  part.events = static_cast<std::uint32_t>(events.size());
  if (events.empty()) {
    return;
  }
  part.first = toRosTime(events.front().stamp);
  std::vector<std::uint64_t> delays;
  std::int64_t last = events.front().stamp;
  std::uint64_t largest_id = 0;
  for (const core::Event& event : events) {
    if (event.stamp < last) {
      throw std::invalid_argument("the time of events to be packed goes back");
    }
    delays.push_back(static_cast<std::uint64_t>(event.stamp - last));
    last = event.stamp;
    largest_id = std::max<std::uint64_t>(largest_id, event.id);
  }
  const int delay_bits = shortestDelayBits(delays);
  int id_bits = 0;
  while (largest_id >> id_bits > 0) {
    ++id_bits;
  }
  part.delay_bits = static_cast<std::uint8_t>(delay_bits);
  part.id_bits = static_cast<std::uint8_t>(id_bits);
  BitWriter writer(part.packed);
  for (std::size_t k = 0; k < events.size(); ++k) {
    const std::uint64_t ones = delays[k] >> delay_bits;
    if (ones < kMostOnes) {
      writer.write((std::uint64_t{1} << (ones + 1)) - 2, static_cast<int>(ones) + 1);
      writer.write(delays[k], delay_bits);
    } else {
      writer.write((std::uint64_t{1} << kMostOnes) - 1, kMostOnes);
      writer.write(delays[k], kWholeBits);
    }
    writer.write(events[k].id, id_bits);
  }
  part.attributes = packAttributes(events);
}

std::vector<core::Event> unpack(const self_awareness::EventLog& part) {
  const std::uint8_t delay_bits = part.delay_bits;
  if (delay_bits > kMostDelayBits || part.id_bits > kMostIdBits) {
    throw std::invalid_argument("packed events have a wrong number of bits");
  }
  std::vector<core::Event> unpacked;
  // Each has one bit at least: damaged numbers do not ask for much memory.
  unpacked.reserve(std::min<std::size_t>(part.events, 8 * part.packed.size()));
  BitReader reader(part.packed);
  std::int64_t stamp = fromRosTime(part.first);
  for (std::uint32_t k = 0; k < part.events; ++k) {
    std::uint64_t ones = 0;
    while (ones < kMostOnes && reader.read(1) == 1) {
      ++ones;
    }
    const bool runs_over = ones < kMostOnes && ones > kMostDelay >> delay_bits;
    const std::uint64_t delay =
        ones < kMostOnes ? ones << delay_bits | reader.read(delay_bits) : reader.read(kWholeBits);
    if (runs_over || delay > kMostDelay - static_cast<std::uint64_t>(stamp)) {
      throw std::invalid_argument("the time of packed events runs over");
    }
    stamp += static_cast<std::int64_t>(delay);
    unpacked.push_back({stamp, static_cast<core::EventId>(reader.read(part.id_bits))});
  }
  if (reader.bytes() != part.packed.size()) {
    throw std::invalid_argument("packed events are followed by other bytes");
  }
  unpackAttributes(part.attributes, unpacked);
  return unpacked;
}

}  // namespace self_awareness::ros1
