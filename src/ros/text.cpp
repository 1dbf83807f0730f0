#include "text.h"

#include <algorithm>
#include <boost/locale/utf.hpp>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::ros1 {
namespace {

using Utf8 = boost::locale::utf::utf_traits<char>;

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD
constexpr std::size_t kLongestCharacter = 4;               // [bytes]

/// The character that the bytes begin with.
struct Character {
  boost::locale::utf::code_point code = 0;
  std::size_t length = 0;  // [bytes]; 0: they begin with none
};

Character characterOf(std::string_view bytes) {
  const char* at = bytes.data();
  const auto code = Utf8::decode(at, bytes.data() + bytes.size());
  const bool is_one =
      code != boost::locale::utf::illegal && code != boost::locale::utf::incomplete;
  return {code, is_one ? static_cast<std::size_t>(at - bytes.data()) : 0};
}

/// Whether a character controls the terminal, turns the order of what follows it around, or breaks
/// the line: a name with one reads as another name.
bool isMisleading(boost::locale::utf::code_point code) {
  return code < 0x20 || (code >= 0x7F && code <= 0x9F) || code == 0x061C || code == 0x200E ||
         code == 0x200F || (code >= 0x2028 && code <= 0x202E) ||
         (code >= 0x2066 && code <= 0x2069);
}

/// The first bytes, without a character that this cuts.
std::string_view firstBytes(std::string_view bytes, std::size_t most) {
  if (bytes.size() <= most) {
    return bytes;
  }
  const std::size_t earliest = most - std::min(most, kLongestCharacter - 1);
  for (std::size_t begin = most; begin-- > earliest;) {
    if (Utf8::trail_length(bytes[begin]) >= 0) {
      const std::size_t length = characterOf(bytes.substr(begin)).length;
      return bytes.substr(0, length > 0 && begin + length > most ? begin : most);
    }
  }
  return bytes.substr(0, most);
}

}  // namespace

bool isPrintable(std::string_view bytes) {
  while (!bytes.empty()) {
    const auto [code, length] = characterOf(bytes);
    if (length == 0 || isMisleading(code)) {
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
    const auto [code, length] = characterOf(bytes);
    text += length == 0 || isMisleading(code) ? kReplacement : bytes.substr(0, length);
    bytes.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return text;
}

std::string shortened(std::string_view bytes, std::size_t most) {
  return printable(bytes, most) + (bytes.size() > most ? "..." : "");
}

std::string utc(std::int64_t time) {
  return core::inUtc(time, "%Y-%m-%d %H:%M:%S UTC");
}

}  // namespace self_awareness::ros1
