#include "text.h"

#include <algorithm>
#include <ctime>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::ros1 {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD
constexpr std::size_t kLongestCharacter = 4;               // [bytes]

bool isBetween(char byte, unsigned low, unsigned high) {
  const auto value = static_cast<unsigned char>(byte);
  return value >= low && value <= high;
}

/// Length that the first byte of a character announces; 0: none begins like this.
std::size_t announcedLength(char first) {
  return isBetween(first, 0x00, 0x7F)   ? 1
         : isBetween(first, 0xC2, 0xDF) ? 2
         : isBetween(first, 0xE0, 0xEF) ? 3
         : isBetween(first, 0xF0, 0xF4) ? 4
                                        : 0;
}

/// Whether the second byte may follow the first (RFC 3629, section 4): no overlong form, no
/// surrogate, nothing above U+10FFFF.
bool mayFollow(char first, char second) {
  switch (static_cast<unsigned char>(first)) {
    case 0xE0:
      return isBetween(second, 0xA0, 0xBF);
    case 0xED:
      return isBetween(second, 0x80, 0x9F);
    case 0xF0:
      return isBetween(second, 0x90, 0xBF);
    case 0xF4:
      return isBetween(second, 0x80, 0x8F);
    default:
      return isBetween(second, 0x80, 0xBF);
  }
}

/// Length of the character that the bytes begin with; 0: they begin with none.
std::size_t characterLength(std::string_view bytes) {
  const std::size_t length = announcedLength(bytes[0]);
  if (length == 0 || length > bytes.size() || (length > 1 && !mayFollow(bytes[0], bytes[1]))) {
    return 0;
  }
  const bool whole = std::all_of(bytes.begin() + 1, bytes.begin() + static_cast<int>(length),
                                 [](char byte) { return isBetween(byte, 0x80, 0xBF); });
  return whole ? length : 0;
}

bool isControl(std::string_view character) {
  return (character.size() == 1 &&
          (isBetween(character[0], 0x00, 0x1F) || character[0] == '\x7F')) ||
         (character.size() == 2 && character[0] == '\xC2' && isBetween(character[1], 0x80, 0x9F));
}

/// Whether a character turns the order of what follows it around, or breaks the line: a name with
/// one reads as another name.
bool isMisleading(std::string_view character) {
  if (character == "\xD8\x9C") {  // U+061C
    return true;
  }
  if (character.size() != 3 || character[0] != '\xE2') {
    return false;
  }
  return character[1] == '\x80'
             // U+200E, U+200F, and U+2028 to U+202E
             ? isBetween(character[2], 0x8E, 0x8F) || isBetween(character[2], 0xA8, 0xAE)
             // U+2066 to U+2069
             : character[1] == '\x81' && isBetween(character[2], 0xA6, 0xA9);
}

/// Length of the character that the bytes begin with, if it may be shown; else 0.
std::size_t printableLength(std::string_view bytes) {
  const std::size_t length = characterLength(bytes);
  const std::string_view character = bytes.substr(0, length);
  return isControl(character) || isMisleading(character) ? 0 : length;
}

/// The first bytes, without a character that this cuts.
std::string_view firstBytes(std::string_view bytes, std::size_t most) {
  if (bytes.size() <= most) {
    return bytes;
  }
  const std::size_t earliest = most - std::min(most, kLongestCharacter - 1);
  for (std::size_t begin = most; begin-- > earliest;) {
    if (announcedLength(bytes[begin]) > 0) {
      const std::size_t length = characterLength(bytes.substr(begin));
      return bytes.substr(0, length > 0 && begin + length > most ? begin : most);
    }
  }
  return bytes.substr(0, most);
}

}  // namespace

bool isPrintable(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::size_t length = printableLength(bytes);
    if (length == 0) {
      return false;
    }
    bytes.remove_prefix(length);
  }
  return true;
}

std::string printable(std::string_view bytes, std::size_t most) {
  bytes = firstBytes(bytes, most);
  std::string text;
  text.reserve(bytes.size());
  while (!bytes.empty()) {
    const bool shown = printableLength(bytes) > 0;
    const std::size_t length = std::max<std::size_t>(characterLength(bytes), 1);
    text += shown ? bytes.substr(0, length) : kReplacement;
    bytes.remove_prefix(length);
  }
  return text;
}

std::string shortened(std::string_view bytes, std::size_t most) {
  return printable(bytes, most) + (bytes.size() > most ? "..." : "");
}

std::string utc(std::int64_t time) {
  const std::time_t seconds = time / core::kNanosecondsPerSecond;
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S UTC", &parts);
  return text;
}

}  // namespace self_awareness::ros1
