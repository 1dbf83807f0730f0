#include "self_awareness/ros/bag/bag_writer.h"

#include <roslz4/lz4s.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "bag_records.h"
#include "self_awareness/ros/bag/bag_reader.h"
#include "self_awareness/ros/output_file.h"

namespace self_awareness::ros1 {
namespace {

using namespace bag_records;  // NOLINT: the format's words, in this file only

// As rosbag's writer has them.
constexpr std::size_t kChunkBytes = std::size_t{768} * 1024;
constexpr int kLz4BlockSize = 6;  // 1 MB

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

std::string fieldOfOp(Op op) {
  return numberOf("op", static_cast<std::uint8_t>(op));
}

std::string timeBytes(const ros::Time& time) {
  return bytesOf(time.sec) + bytesOf(time.nsec);
}

std::string recordOf(std::string_view header, std::string_view data) {
  return block(header) + block(data);
}

/// By LZ4, in the frames that rosbag reads.
std::string compressed(std::string data) {
  // What cannot be compressed grows by a few bytes a block.
  std::string packed(data.size() + data.size() / 100 + kFileHeaderBytes, '\0');
  auto size = static_cast<unsigned int>(packed.size());
  if (roslz4_buffToBuffCompress(&data[0], static_cast<unsigned int>(data.size()), &packed[0],
                                &size, kLz4BlockSize) != ROSLZ4_OK) {
    throw std::bad_alloc();  // nothing else can go wrong
  }
  packed.resize(size);
  return packed;
}

}  // namespace

BagWriter::BagWriter(std::string path, Chunks chunks, std::string named)
    : path_(std::move(path)),
      kind_(chunks),
      named_(named.empty() ? path_ : std::move(named)),
      file_(std::fopen(path_.c_str(), "wb")) {
  if (!file_) {
    fail();
  }
  append(std::string(kFormat) + std::string(kFileHeaderBytes + 2 * sizeof(std::uint32_t), ' '));
  writeFileHeader(0);
}

void BagWriter::write(const ros::Time& stamp, const Topic& topic, const Type& type) {
  const auto [entry, is_new] =
      numbers_.try_emplace(topic.name, static_cast<std::uint32_t>(connections_.size()));
  const std::uint32_t number = entry->second;
  if (is_new) {
    std::string data =
        fieldOf("callerid", topic.callerid) + fieldOf("latching", topic.latching ? "1" : "0") +
        fieldOf("md5sum", type.md5sum) + fieldOf("message_definition", type.definition) +
        fieldOf("topic", topic.name) + fieldOf("type", type.datatype);
    for (const auto& [name, value] : topic.more) {
      data += fieldOf(name, value);
    }
    connections_.push_back(recordOf(
        numberOf("conn", number) + fieldOfOp(Op::kConnection) + fieldOf("topic", topic.name),
        data));
    waiting_ += connections_.back();
  }
  places_[number].push_back({stamp, static_cast<std::uint32_t>(waiting_.size())});
  waiting_ += recordOf(
      numberOf("conn", number) + fieldOfOp(Op::kMessage) + fieldOf("time", timeBytes(stamp)),
      {reinterpret_cast<const char*>(content_.data()), content_.size()});
  if (kind_ == Chunks::kOfOneMessage || waiting_.size() >= kChunkBytes) {
    writeChunk();
  }
}

void BagWriter::writeChunk() {
  Chunk chunk;
  chunk.position = size_;
  chunk.first = ros::TIME_MAX;
  std::string index;
  for (auto& [number, places] : places_) {
    // As rosbag's writer: its Python library reads messages in the order of the index.
    std::stable_sort(places.begin(), places.end(),
                     [](const Place& a, const Place& b) { return a.stamp < b.stamp; });
    std::string entries;
    for (const Place& place : places) {
      chunk.first = std::min(chunk.first, place.stamp);
      chunk.last = std::max(chunk.last, place.stamp);
      entries += timeBytes(place.stamp) + bytesOf(place.offset);
    }
    const auto count = static_cast<std::uint32_t>(places.size());
    chunk.counts.emplace_back(number, count);
    index += recordOf(numberOf("conn", number) + numberOf("count", count) + fieldOfOp(Op::kIndex) +
                          numberOf("ver", std::uint32_t{1}),
                      entries);
  }
  const bool compress = kind_ == Chunks::kCompressed;
  const std::string header = fieldOf("compression", compress ? "lz4" : "none") +
                             fieldOfOp(Op::kChunk) +
                             numberOf("size", static_cast<std::uint32_t>(waiting_.size()));
  append(recordOf(header, compress ? compressed(std::move(waiting_)) : waiting_) + index);
  waiting_.clear();
  places_.clear();
  chunks_.push_back(std::move(chunk));
}

void BagWriter::close() {
  if (!places_.empty()) {
    writeChunk();
  }
  const std::uint64_t index = size_;
  std::string rest;
  for (const std::string& connection : connections_) {
    rest += connection;
  }
  for (const Chunk& chunk : chunks_) {
    std::string counts;
    for (const auto& [connection, count] : chunk.counts) {
      counts += bytesOf(connection) + bytesOf(count);
    }
    rest += recordOf(numberOf("chunk_pos", chunk.position) +
                         numberOf("count", static_cast<std::uint32_t>(chunk.counts.size())) +
                         fieldOf("end_time", timeBytes(chunk.last)) + fieldOfOp(Op::kChunkInfo) +
                         fieldOf("start_time", timeBytes(chunk.first)) +
                         numberOf("ver", std::uint32_t{1}),
                     counts);
  }
  append(rest);
  writeFileHeader(index);
  if (std::fclose(file_.release()) != 0) {
    fail();
  }
}

void BagWriter::writeFileHeader(std::uint64_t index) {
  const std::string header =
      numberOf("chunk_count", static_cast<std::uint32_t>(chunks_.size())) +
      numberOf("conn_count", static_cast<std::uint32_t>(connections_.size())) +
      numberOf("index_pos", index) + fieldOfOp(Op::kFileHeader);
  const std::string bytes = recordOf(header, std::string(kFileHeaderBytes - header.size(), ' '));
  if (std::fseek(file_.get(), static_cast<long>(kFormat.size()), SEEK_SET) != 0 ||
      std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size() ||
      std::fseek(file_.get(), 0, SEEK_END) != 0 || std::fflush(file_.get()) != 0) {
    fail();
  }
}

void BagWriter::append(const std::string& bytes) {
  if (!file_) {
    throw std::logic_error(named_ + ": is closed, or could not be written before");
  }
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size() ||
      std::fflush(file_.get()) != 0) {
    fail();
  }
  size_ += bytes.size();
}

void BagWriter::fail() {
  const int error = errno;
  file_.reset();
  throw BagError(writeProblem(named_, error, named_ == path_ ? "" : path_));
}

}  // namespace self_awareness::ros1
