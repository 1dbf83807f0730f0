#include "bag_records.h"

#include <algorithm>

namespace self_awareness::ros1::bag_records {

PiecesOfFile::PiecesOfFile(const std::string& path) {
  file_.rdbuf()->pubsetbuf(nullptr, 0);
  file_.open(path, std::ios::binary | std::ios::ate);
  size_ = static_cast<std::uint64_t>(std::max<std::streamoff>(file_.tellg(), 0));
}

std::string_view PiecesOfFile::at(std::uint64_t position, std::uint64_t bytes,
                                  std::uint64_t ahead) {
  if (position > size_) {
    throw FormatError("a position beyond the end of the file");
  }
  bytes = std::min(bytes, size_ - position);
  if (position < position_ || position + bytes > position_ + buffer_.size()) {
    position_ = position;
    buffer_.resize(std::min(bytes + ahead, size_ - position));
    file_.seekg(static_cast<std::streamoff>(position));
    if (!file_.read(&buffer_[0], static_cast<std::streamsize>(buffer_.size()))) {
      throw FormatError("the file cannot be read");
    }
  }
  return std::string_view(buffer_).substr(position - position_, bytes);
}

Chunk::Chunk(PiecesOfFile& file, std::uint64_t position) {
  std::string_view bytes = file.at(position, kHeaderBytes);
  const std::size_t all = bytes.size();
  const std::string_view header = takeHeader(bytes, Op::kChunk);
  // The format leaves the order of the fields open. Python's rosbag begins with the operation;
  // that in C++ writes them in alphabetical order.
  std::string_view fields = header;
  by_python = takeField(fields).first == "op";
  compression = field(header, "compression");
  unpacked_bytes = number<std::uint32_t>(header, "size");
  const auto size = takeNumber<std::uint32_t>(bytes);
  begin = position + (all - bytes.size());
  end = begin + size;
}

}  // namespace self_awareness::ros1::bag_records
