#include "self_awareness/ros/bag/bag_writer.h"

#include <cerrno>
#include <cstring>
#include <string_view>

#include "bag_records.h"
#include "self_awareness/ros/bag/bag_reader.h"

namespace self_awareness::ros1 {
namespace {

using namespace bag_records;  // NOLINT: the format's words, in this file only

// Header and data of the file's header are of this length together, so that they can be written
// again at the end; rosbag does so, too, and does not look how long they are.
constexpr std::size_t kFileHeaderBytes = 4096;
constexpr char kCallerId[] = "/self_awareness";

template <typename Number>
std::string bytesOf(Number number) {
  std::string bytes(sizeof number, '\0');
  std::memcpy(&bytes[0], &number, sizeof number);
  return bytes;
}

std::string block(std::string_view bytes) {
  return bytesOf(static_cast<std::uint32_t>(bytes.size())).append(bytes);
}

std::string fieldOf(std::string_view name, std::string_view value) {
  return block(std::string(name).append("=").append(value));
}

template <typename Number>
std::string numberOf(std::string_view name, Number number) {
  return fieldOf(name, bytesOf(number));
}

std::string opOf(Op op) {
  return numberOf("op", static_cast<std::uint8_t>(op));
}

std::string timeBytes(const ros::Time& time) {
  return bytesOf(time.sec) + bytesOf(time.nsec);
}

std::string recordOf(std::string_view header, std::string_view data) {
  return block(header) + block(data);
}

}  // namespace

BagWriter::BagWriter(std::string path)
    : path_(std::move(path)), file_(std::fopen(path_.c_str(), "wb")) {
  if (!file_) {
    fail();
  }
  append(std::string(kFormat) + std::string(kFileHeaderBytes + 2 * sizeof(std::uint32_t), ' '));
  writeFileHeader(0);
}

BagWriter::~BagWriter() = default;

void BagWriter::write(const ros::Time& stamp, const Connection& connection) {
  const auto [number, is_new] =
      numbers_.try_emplace(connection.topic, static_cast<std::uint32_t>(connections_.size()));
  std::string data;
  if (is_new) {
    connections_.push_back(connection);
    data = record(number->second, connection);
  }
  const auto offset = static_cast<std::uint32_t>(data.size());
  data += recordOf(
      numberOf("conn", number->second) + opOf(Op::kMessage) + fieldOf("time", timeBytes(stamp)),
      {reinterpret_cast<const char*>(content_.data()), content_.size()});
  const std::uint64_t position = size_;
  std::string chunk = recordOf(fieldOf("compression", "none") + opOf(Op::kChunk) +
                                   numberOf("size", static_cast<std::uint32_t>(data.size())),
                               data);
  chunk += recordOf(numberOf("conn", number->second) + numberOf("count", std::uint32_t{1}) +
                        opOf(Op::kIndex) + numberOf("ver", std::uint32_t{1}),
                    timeBytes(stamp) + bytesOf(offset));
  append(chunk);
  chunks_.push_back({position, stamp, number->second});
}

void BagWriter::close() {
  const std::uint64_t index = size_;
  std::string rest;
  for (const auto& [topic, number] : numbers_) {
    rest += record(number, connections_[number]);
  }
  for (const Chunk& chunk : chunks_) {
    rest += recordOf(numberOf("chunk_pos", chunk.position) + numberOf("count", std::uint32_t{1}) +
                         fieldOf("end_time", timeBytes(chunk.stamp)) + opOf(Op::kChunkInfo) +
                         fieldOf("start_time", timeBytes(chunk.stamp)) +
                         numberOf("ver", std::uint32_t{1}),
                     bytesOf(chunk.connection) + bytesOf(std::uint32_t{1}));
  }
  append(rest);
  writeFileHeader(index);
  if (std::fclose(file_.release()) != 0) {
    fail();
  }
}

std::string BagWriter::record(std::uint32_t number, const Connection& connection) {
  return recordOf(
      numberOf("conn", number) + opOf(Op::kConnection) + fieldOf("topic", connection.topic),
      fieldOf("callerid", kCallerId) + fieldOf("latching", "0") +
          fieldOf("md5sum", connection.md5sum) +
          fieldOf("message_definition", connection.definition) +
          fieldOf("topic", connection.topic) + fieldOf("type", connection.datatype));
}

void BagWriter::writeFileHeader(std::uint64_t index) {
  const std::string header =
      numberOf("chunk_count", static_cast<std::uint32_t>(chunks_.size())) +
      numberOf("conn_count", static_cast<std::uint32_t>(connections_.size())) +
      numberOf("index_pos", index) + opOf(Op::kFileHeader);
  const std::string bytes = recordOf(header, std::string(kFileHeaderBytes - header.size(), ' '));
  if (std::fseek(file_.get(), static_cast<long>(kFormat.size()), SEEK_SET) != 0 ||
      std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size() ||
      std::fseek(file_.get(), 0, SEEK_END) != 0 || std::fflush(file_.get()) != 0) {
    fail();
  }
}

void BagWriter::append(const std::string& bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size() ||
      std::fflush(file_.get()) != 0) {
    fail();
  }
  size_ += bytes.size();
}

void BagWriter::fail() const {
  throw BagError(path_ + ": cannot be written (" + std::strerror(errno) + ")");
}

}  // namespace self_awareness::ros1
