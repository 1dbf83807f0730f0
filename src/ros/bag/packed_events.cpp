#include "packed_events.h"

#include <zlib.h>

#include <array>
#include <limits>
#include <new>
#include <stdexcept>
#include <unordered_map>
#include <utility>

namespace self_awareness::ros1 {
namespace {

constexpr std::size_t kDelayBytes = 8;
constexpr std::size_t kIdBytes = 4;
constexpr unsigned kSame = core::Attributes::kSteps;  // added to a step: the content is the same

/// What is known of a message: age, size, and what its number and its content say.
using Attributes = std::array<std::uint8_t, 3>;
/// An event: the delay since the one before and its id, the lowest byte first, and what differs
/// from the attributes of the one before of its type.
using Row = std::array<std::uint8_t, kDelayBytes + kIdBytes + Attributes().size()>;

Attributes bytesOf(const core::Attributes& attributes) {
  return {attributes.age, attributes.size,
          static_cast<std::uint8_t>(static_cast<unsigned>(attributes.step) |
                                    (attributes.same ? kSame : 0U))};
}

core::Attributes attributesOf(const Attributes& bytes) {
  if (bytes[2] >= 2 * kSame) {
    throw std::invalid_argument("attributes of packed events that cannot be");
  }
  return {bytes[0], bytes[1], static_cast<core::Attributes::Step>(bytes[2] % kSame),
          bytes[2] >= kSame};
}

void put(std::uint64_t number, std::size_t begin, std::size_t bytes, Row& row) {
  for (std::size_t k = 0; k < bytes; ++k, number >>= 8U) {
    row[begin + k] = static_cast<std::uint8_t>(number);
  }
}

std::uint64_t numberIn(const Row& row, std::size_t begin, std::size_t bytes) {
  std::uint64_t number = 0;
  for (std::size_t k = bytes; k > 0; --k) {
    number = number << 8U | row[begin + k - 1];
  }
  return number;
}

}  // namespace

// The columns are packed, one behind the other: most of the upper ones hardly change.
PackedEvents PackedEvents::pack(const std::vector<core::Event>& events) {
  if (events.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw std::invalid_argument("too many events to pack together");
  }
  std::vector<std::uint8_t> columns(events.size() * Row().size());
  std::unordered_map<core::EventId, Attributes> of_type;
  std::int64_t last = 0;
  for (std::size_t k = 0; k < events.size(); ++k) {
    const core::Event& event = events[k];
    if (event.stamp < last) {
      throw std::invalid_argument("the time of events to be packed goes back");
    }
    Row row;
    put(static_cast<std::uint64_t>(event.stamp - std::exchange(last, event.stamp)), 0, kDelayBytes,
        row);
    put(event.id, kDelayBytes, kIdBytes, row);
    const Attributes now = bytesOf(event.attributes);
    const Attributes before = std::exchange(of_type[event.id], now);
    for (std::size_t part = 0; part < now.size(); ++part) {
      row[kDelayBytes + kIdBytes + part] = now[part] ^ before[part];
    }
    for (std::size_t column = 0; column < row.size(); ++column) {
      columns[column * events.size() + k] = row[column];
    }
  }
  PackedEvents packed;
  packed.events = static_cast<std::uint32_t>(events.size());
  uLongf size = compressBound(columns.size());
  packed.bytes.resize(size);
  if (compress(packed.bytes.data(), &size, columns.data(), columns.size()) != Z_OK) {
    throw std::bad_alloc();  // nothing else can go wrong
  }
  packed.bytes.resize(size);
  return packed;
}

std::vector<core::Event> PackedEvents::unpack() const {
  std::vector<std::uint8_t> columns(events * Row().size() + 1);  // zlib needs a byte for none
  uLongf size = columns.size();
  uLong used = bytes.size();
  if (uncompress2(columns.data(), &size, bytes.data(), &used) != Z_OK || used != bytes.size() ||
      size != columns.size() - 1) {
    throw std::invalid_argument("packed events are damaged");
  }
  std::vector<core::Event> unpacked(events);
  std::unordered_map<core::EventId, Attributes> of_type;
  std::uint64_t stamp = 0;
  for (std::size_t k = 0; k < unpacked.size(); ++k) {
    Row row;
    for (std::size_t column = 0; column < row.size(); ++column) {
      row[column] = columns[column * unpacked.size() + k];
    }
    const std::uint64_t delay = numberIn(row, 0, kDelayBytes);
    if (delay > std::numeric_limits<std::int64_t>::max() - stamp) {
      throw std::invalid_argument("the time of packed events runs over");
    }
    stamp += delay;
    const auto id = static_cast<core::EventId>(numberIn(row, kDelayBytes, kIdBytes));
    Attributes& attributes = of_type[id];
    for (std::size_t part = 0; part < attributes.size(); ++part) {
      attributes[part] ^= row[kDelayBytes + kIdBytes + part];
    }
    unpacked[k] = {static_cast<std::int64_t>(stamp), id, attributesOf(attributes)};
  }
  return unpacked;
}

}  // namespace self_awareness::ros1
