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

}  // namespace

AttributeReader::AttributeReader(const Connection& connection)
    : place_(placeOfHeader(connection.definition, connection.datatype)),
      header_end_(place_ ? *place_ + kHeader : 0),
      is_read_(connection.datatype != "rosgraph_msgs/Log"),
      is_numbered_(!connection.latching) {}

void AttributeReader::begin(std::uint64_t size) {
  size_ = size;
  position_ = 0;
  content_ = 0;
  header_.fill(0);
  sample_.clear();
}

void AttributeReader::add(const std::uint8_t* data, std::size_t size) {
  if (!is_read_) {
    return;
  }
  if (position_ < header_end_) {
    const std::uint64_t of_header = std::min<std::uint64_t>(header_end_ - position_, size);
    std::copy_n(data, of_header, header_.begin() + static_cast<std::ptrdiff_t>(position_));
    if (isFirst()) {
      position_ += of_header;
      data += of_header;
      size -= of_header;
      if (position_ == kHeader) {
        content_ = std::min(kHeader + std::uint64_t{numberAt(kHeader - 4)}, size_);
      }
    }
  }
  sample(data, size);
}

template <typename Function>
void AttributeReader::forEachSample(Function function) const {
  const std::uint64_t content = size_ - content_;
  if (content <= kBlocks * kBlock) {
    function(content_, size_);
    return;
  }
  for (std::uint64_t block = 0; block < kBlocks; ++block) {
    const std::uint64_t from = content_ + block * (content - kBlock) / (kBlocks - 1);
    function(from, from + kBlock);
  }
}

AttributeReader::Part AttributeReader::next() const {
  if (!is_read_) {
    return {size_, size_};
  }
  if (position_ < header_end_) {
    return {position_, std::min<std::uint64_t>(header_end_, size_)};
  }
  Part part{size_, size_};
  forEachSample([&](std::uint64_t from, std::uint64_t to) {
    if (position_ < to && from < part.begin) {
      part = {std::max(from, position_), to};
    }
  });
  return part;
}

void AttributeReader::sample(const std::uint8_t* data, std::uint64_t size) {
  forEachSample([&](std::uint64_t from, std::uint64_t to) {
    const std::uint64_t first = std::max(from, position_);
    const std::uint64_t last = std::min(to, position_ + size);
    if (first < last) {
      sample_.insert(sample_.end(), data + (first - position_), data + (last - position_));
    }
  });
  position_ += size;
}

core::Attributes AttributeReader::end(std::int64_t now) {
  core::Attributes attributes;
  if (!is_read_) {
    return attributes;
  }
  attributes.size = core::sizeClass(size_);
  const std::uint64_t content = size_ - content_;
  attributes.same = last_same_ = last_content_ == content && sample_ == last_sample_;
  last_content_ = content;
  sample_.swap(last_sample_);
  if (place_ && position_ >= header_end_ && (isFirst() || numberAt(0) > 0)) {
    readHeader(now, attributes);
  }
  return attributes;
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

std::uint32_t AttributeReader::numberAt(std::size_t place) const {
  std::uint32_t number = 0;  // little-endian, as the machines that ROS runs on
  std::memcpy(&number, header_.data() + place, sizeof number);
  return number;
}

void AttributeReader::readHeader(std::int64_t now, core::Attributes& attributes) {
  if (isFirst()) {
    const std::uint32_t number = numberAt(0);
    if (last_number_ && is_numbered_) {
      attributes.step = core::stepOf(*last_number_, number);
    }
    last_number_ = number;
  }
  const std::int64_t stamp =
      std::int64_t{numberAt(*place_ + 4)} * 1000000000 + std::int64_t{numberAt(*place_ + 8)};
  attributes.age = stamp == 0 ? core::Attributes::kZeroStamp : core::ageClass(now - stamp);
}

}  // namespace self_awareness::ros1
