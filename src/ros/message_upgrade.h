#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "message_definition.h"

namespace self_awareness::ros1 {

/// Lays a serialized message out anew: from what one definition of its type says to what another
/// one says. Fields are matched by their names, in messages within it, too. What the new layout
/// does not have is left out; what the old one lacks becomes zero or empty.
///
/// The old definition and the bytes may be a stranger's (docs/monitor.md): each length is checked
/// against the message, and the time that it takes follows the size of the message.
class MessageUpgrade {
 public:
  /// @param from as in the file
  /// @param to of this program
  /// @throw std::invalid_argument if a field has one type there and another one here, or a bound
  /// of the definition is exceeded; names the field
  MessageUpgrade(const MessageDefinition& from, const MessageDefinition& to);

  /// @return the message in the new layout
  /// @throw std::invalid_argument if the bytes do not fit the old definition, or the message
  /// becomes larger than one can be (MessageDefinition::kLargestMessage)
  std::vector<std::uint8_t> apply(const std::uint8_t* data, std::size_t size) const;

 private:
  struct Layout;
  class Builder;
  class Writer;

  std::shared_ptr<const Layout> layout_;
};

}  // namespace self_awareness::ros1
