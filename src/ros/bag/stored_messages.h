#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "../check.h"
#include "../content_digest.h"
#include "../message_upgrade.h"
#include "bag_index.h"
#include "bag_messages.h"

namespace self_awareness::ros1 {

/// Whether a connection's messages are of this type, in whatever version of it.
template <typename Message>
bool holds(const Connection& connection) {
  return connection.datatype == ros::message_traits::datatype<Message>();
}

/// Reads the messages of a file of this package, whatever version wrote it: by the definitions
/// that the file holds.
class StoredMessages {
 public:
  /// @param index of the bag; must live as long as this object
  /// @param largest as in BagMessages
  /// @throw rosbag::BagException if the file cannot be opened
  StoredMessages(const std::string& path, const BagIndex& index,
                 std::uint64_t largest = bag_records::kLargestChunk)
      : index_(&index), messages_(path, index.numbers, largest) {}

  /// @param entry of a connection that holds this type of message
  /// @throw rosbag::BagException if it cannot be read
  /// @param digest the message is added to it, as it lies in the file; null: to none
  /// @throw std::invalid_argument if it is damaged, or a field of it has another type here
  template <typename Message>
  Message read(const BagIndexEntry& entry, ContentDigest* digest = nullptr) {
    namespace traits = ros::message_traits;
    messages_.read(entry, content_);
    if (digest != nullptr) {
      digest->add(content_.data(), content_.size());
    }
    if (index_->connections[entry.connection].md5sum != traits::md5sum<Message>()) {
      upgrade(entry.connection, traits::definition<Message>());
    }
    return readMessage<Message>(content_.data(), content_.size());
  }

 private:
  /// Lays the message out as this program's definition says.
  void upgrade(std::uint32_t connection, const std::string& definition) {
    auto found = upgrades_.find(connection);
    if (found == upgrades_.end()) {
      const Connection& stored = index_->connections[connection];
      const MessageDefinition from(stored.definition, stored.datatype);
      found =
          upgrades_.emplace(connection, MessageUpgrade(from, {definition, stored.datatype})).first;
    }
    content_ = found->second.apply(content_.data(), content_.size());
  }

  const BagIndex* index_;
  BagMessages messages_;
  std::map<std::uint32_t, MessageUpgrade> upgrades_;  // by connection
  std::vector<std::uint8_t> content_;
};

}  // namespace self_awareness::ros1
