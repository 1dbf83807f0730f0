#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "message_definition.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/stream/listed.h"

namespace self_awareness::ros1 {

/// Reads what the messages of one connection list, and knows when there is something to tell.
class ListedField {
 public:
  /// What lasts is told again so often [ns].
  static constexpr std::int64_t kAgain = core::kNanosecondsPerSecond;
  /// Who has more lists than so many invents them: they are not told apart any more.
  static constexpr std::size_t kMostLists = 16;

  /// @param path of the field that `field` was found by
  ListedField(std::string path, MessageDefinition::ListField field);

  /// Takes in the next message.
  /// @param stamp [ns]
  /// @return what it lists, where that is another than before, or was told kAgain ago: texts, or
  /// the largest number; none: there is nothing to tell
  /// @throw std::out_of_range if the message is shorter than its definition
  std::optional<core::Listed> next(const std::uint8_t* data, std::size_t size, std::int64_t stamp);

 private:
  /// Calls use() with the type of each element's field, and a cursor that is at it.
  template <typename Use>
  void forEach(const std::uint8_t* data, std::size_t size, const Use& use) const;
  std::set<std::string> read(const std::uint8_t* data, std::size_t size) const;
  /// Whether a message lists the same in the same order as the one before: most do.
  bool isAsBefore(const std::uint8_t* data, std::size_t size);

  std::string path_;
  MessageDefinition::ListField field_;
  std::string texts_;         // of the last message
  std::string texts_before_;  // of the one before
  std::set<std::string> last_;
  std::optional<std::int64_t> told_;  // when [ns]
  std::set<std::set<std::string>> lists_;
};

}  // namespace self_awareness::ros1
