#include "self_awareness/ros/attribute_reader.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "message_definition.h"

namespace self_awareness::ros1 {
namespace {

bool beginsWithHeader(const std::string& definition, const std::string& datatype) {
  const MessageDefinition::Lines header{
      {"uint32", "", "seq"}, {"time", "", "stamp"}, {"string", "", "frame_id"}};
  try {
    const MessageDefinition types(definition, datatype);
    const MessageDefinition::Lines& fields = types.linesOf(datatype);
    return !fields.empty() && fields.front().type == "std_msgs/Header" &&
           fields.front().array.empty() && types.linesOf("std_msgs/Header") == header;
  } catch (const std::invalid_argument&) {
    return false;  // too long, or without the definition of the header
  }
}

}  // namespace

AttributeReader::AttributeReader(const Connection& connection)
    : has_header_(beginsWithHeader(connection.definition, connection.datatype)),
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
  std::uint64_t skipped = 0;
  if (has_header_ && position_ < kHeader) {
    skipped = std::min<std::uint64_t>(kHeader - position_, size);
    std::copy_n(data, skipped, header_.begin() + static_cast<std::ptrdiff_t>(position_));
    position_ += skipped;
    if (position_ == kHeader) {
      content_ = std::min(kHeader + std::uint64_t{numberAt(kHeader - 4)}, size_);
    }
  }
  sample(data + skipped, size - skipped);
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
  if (has_header_ && position_ < kHeader) {
    return {position_, std::min<std::uint64_t>(kHeader, size_)};
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
  if (has_header_ && position_ >= kHeader) {
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
  const std::uint32_t number = numberAt(0);
  if (last_number_ && is_numbered_) {
    attributes.step = core::stepOf(*last_number_, number);
  }
  last_number_ = number;
  const std::int64_t stamp = std::int64_t{numberAt(4)} * 1000000000 + std::int64_t{numberAt(8)};
  attributes.age = stamp == 0 ? core::Attributes::kZeroStamp : core::ageClass(now - stamp);
}

}  // namespace self_awareness::ros1
