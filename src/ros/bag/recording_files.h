#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "bag_index.h"
#include "bag_messages.h"
#include "self_awareness/ros/bag/bag_reader.h"

namespace self_awareness::ros1 {

/// The files of one recording, in their order: a bag, or the bags of `rosbag record --split`. They
/// are read as one bag: a connection that is there again in a later file goes on. What the
/// recorder repeated at the beginning of a file (rosbag record --repeat-latched) is no message,
/// and left out.
class RecordingFiles {
  struct File;

 public:
  /// Reads the index of each.
  /// @param paths one or more
  /// @throw BagError as openBag(), or if a repeated message cannot be read
  explicit RecordingFiles(const std::vector<std::string>& paths,
                          const ChunkProgress& progress = nullptr);

  /// As if the files lay one behind the other: the positions of chunks count on.
  const BagIndex& index() const { return index_; }
  std::vector<BagSummary::File> files() const;
  /// Where the clock was set back: stamps of the index count on.
  const std::vector<SetBack>& setBack() const { return set_back_; }
  /// Reads messages of the files as if they were of one. There may be hundreds, so only the one
  /// that was read last stays open, with its neighbours.
  class Messages {
   public:
    /// @param files must outlive this
    explicit Messages(const RecordingFiles& files) : files_(files.files_) {}
    /// As BagMessages::read().
    /// @throw BagError if it cannot be read, which names the file
    void read(const BagIndexEntry& entry, std::vector<std::uint8_t>& content);
    /// As BagMessages::attributes().
    /// @throw BagError as read()
    core::Attributes attributes(const BagIndexEntry& entry, AttributeReader& reader);

   private:
    template <typename Use>
    auto inItsFile(const BagIndexEntry& entry, const Use& use);

    const std::vector<File>& files_;
    std::map<std::ptrdiff_t, BagMessages> open_;  // by index of the file
  };

 private:
  struct File {
    std::string path;
    std::uint64_t begin = 0;             // where the positions of its chunks begin
    std::int64_t start = 0;              // stamp of its first message [ns]
    std::vector<std::uint32_t> numbers;  // of its connections, by those of index_
  };

  void add(const std::string& path, BagIndex index);
  /// Index in index_ of each connection of a file; new ones are added.
  std::vector<std::uint32_t> join(const BagIndex& index);
  /// Whether a message on a latched connection is the one before it, in an earlier file.
  bool isRepeated(const BagIndexEntry& entry) const;

  std::vector<File> files_;
  BagIndex index_;
  std::vector<SetBack> set_back_;
  std::uint64_t end_ = 0;                                // of the positions of chunks
  std::map<std::uint32_t, BagIndexEntry> last_latched_;  // by connection
};

/// What a recording is called by the files that it lies in: `run_0.bag`, `run_0.bag..4` of five.
/// @param paths one or more
std::string nameOf(const std::vector<std::string>& paths);

/// Finds where the clock was set back while a bag was recorded: messages lie in the file as they
/// came, so stamps go back there, and what came before comes again. Counts on as if it had not
/// been set: by time, what came later would lie among what came before. Bags that are in no order
/// of time, as other programs write them, stay as they are.
/// @param index whose entries get the stamps as they are counted, and stay in their order
/// @return in the order of the recording
std::vector<SetBack> countOn(BagIndex& index);

/// An entry with its stamp as the file has it.
/// @param entry with its stamp as it is counted
BagIndexEntry asStored(BagIndexEntry entry, const std::vector<SetBack>& steps);

}  // namespace self_awareness::ros1
