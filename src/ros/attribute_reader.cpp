#include "self_awareness/ros/attribute_reader.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "message_definition.h"

namespace self_awareness::ros1 {
namespace {

/// Where the header of messages begins [bytes]: at once, or, as transforms have one each and their
/// message has none, behind the length of the array that messages begin with. None: nowhere.
std::optional<std::size_t> placeOfHeader(const std::string& definition,
                                         const std::string& datatype) {
  const MessageDefinition::Lines header{
      {"uint32", "", "seq"}, {"time", "", "stamp"}, {"string", "", "frame_id"}};
  try {
    const MessageDefinition types(definition, datatype);
    const auto beginsWith = [&](const std::string& type, const std::string& array) {
      const MessageDefinition::Lines& fields = types.linesOf(type);
      return !fields.empty() && fields.front().array == array ? fields.front().type : "";
    };
    const std::string element = beginsWith(datatype, "[]");
    const std::string first = beginsWith(element.empty() ? datatype : element, "");
    if (first == "std_msgs/Header" && types.linesOf(first) == header) {
      return element.empty() ? 0 : AttributeReader::kLengthOfArray;
    }
  } catch (const std::invalid_argument&) {
    // Too long, or without the definition of a type that it begins with.
  }
  return std::nullopt;
}

template <typename Head>
std::uint32_t numberAt(std::size_t place, const Head& head) {
  std::uint32_t number = 0;  // little-endian, as the machines that ROS runs on
  std::memcpy(&number, head.data() + place, sizeof number);
  return number;
}

}  // namespace

AttributeReader::AttributeReader(const Connection& connection)
    : place_(placeOfHeader(connection.definition, connection.datatype)),
      is_read_(connection.datatype != "rosgraph_msgs/Log"),
      is_numbered_(!connection.latching) {}

core::Attributes AttributeReader::read(std::uint64_t size, const Bytes& bytes, std::int64_t now) {
  core::Attributes attributes;
  if (!is_read_) {
    return attributes;
  }
  Head head{};
  const bool has_header = place_ && size >= *place_ + kHeader;
  if (has_header) {
    const std::string_view read = bytes(0, *place_ + kHeader);
    std::copy(read.begin(), read.end(), head.begin());
  }
  const std::uint64_t begin =
      has_header && isFirst()
          ? std::min(kHeader + std::uint64_t{numberAt(kHeader - 4, head)}, size)
          : 0;
  sample(begin, size, bytes);
  attributes.size = core::sizeClass(size);
  attributes.same = last_same_ = last_content_ == size - begin && sample_ == last_sample_;
  last_content_ = size - begin;
  sample_.swap(last_sample_);
  if (has_header && (isFirst() || numberAt(0, head) > 0)) {
    readHeader(head, now, attributes);
  }
  return attributes;
}

core::Attributes AttributeReader::read(const std::vector<std::uint8_t>& content,
                                       std::int64_t now) {
  const auto* const data = reinterpret_cast<const char*>(content.data());
  return read(
      content.size(),
      [data](std::uint64_t from, std::uint64_t to) {
        return std::string_view(data + from, to - from);
      },
      now);
}

void AttributeReader::sample(std::uint64_t begin, std::uint64_t size, const Bytes& bytes) {
  const std::uint64_t content = size - begin;
  if (content <= kBlocks * kBlock) {
    sample_ = bytes(begin, size);
    return;
  }
  sample_.clear();
  for (std::uint64_t block = 0; block < kBlocks; ++block) {
    const std::uint64_t from = begin + block * (content - kBlock) / (kBlocks - 1);
    sample_ += bytes(from, from + kBlock);
  }
}

core::Attributes AttributeReader::skip(std::uint64_t size) {
  core::Attributes attributes;
  if (is_read_) {
    attributes.size = core::sizeClass(size);
    attributes.same = last_same_;
    if (last_number_) {
      ++*last_number_;
    }
  }
  return attributes;
}

void AttributeReader::readHeader(const Head& head, std::int64_t now,
                                 core::Attributes& attributes) {
  if (isFirst()) {
    const std::uint32_t number = numberAt(0, head);
    if (last_number_ && is_numbered_) {
      attributes.step = core::stepOf(*last_number_, number);
    }
    last_number_ = number;
  }
  const std::int64_t stamp = std::int64_t{numberAt(*place_ + 4, head)} * 1000000000 +
                             std::int64_t{numberAt(*place_ + 8, head)};
  attributes.age = stamp == 0 ? core::Attributes::kZeroStamp : core::ageClass(now - stamp);
}

}  // namespace self_awareness::ros1
