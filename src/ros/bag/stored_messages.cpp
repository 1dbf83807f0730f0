#include "stored_messages.h"

#include "../message_definition.h"

namespace self_awareness::ros1 {

void StoredMessages::upgrade(std::uint32_t connection, const std::string& definition) {
  auto found = upgrades_.find(connection);
  if (found == upgrades_.end()) {
    const Connection& stored = index_->connections[connection];
    found = upgrades_
                .emplace(connection,
                         MessageUpgrade(MessageDefinition(stored.definition, stored.datatype),
                                        MessageDefinition(definition, stored.datatype)))
                .first;
  }
  content_ = found->second.apply(content_.data(), content_.size());
}

}  // namespace self_awareness::ros1
