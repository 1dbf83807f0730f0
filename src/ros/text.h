#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace self_awareness::ros1 {

/// Whether every program can read the bytes, and every terminal show them as what they are: UTF-8,
/// as of RFC 3629, without characters that control the terminal or the direction of the text.
bool isPrintable(std::string_view bytes);

/// Bytes of a stranger as such a text: what does not belong in it becomes U+FFFD.
/// @param most so many bytes are read; a character that this cuts is left out
std::string printable(std::string_view bytes, std::size_t most = std::string_view::npos);

/// Longest text of a stranger in an error or another sentence [bytes].
constexpr std::size_t kLongestQuote = 100;
/// So much of such a text, in quotation marks.
inline std::string quote(std::string_view bytes) {
  return "'" + printable(bytes, kLongestQuote) + "'";
}
/// As printable(), with "..." at its end if bytes were left out.
std::string shortened(std::string_view bytes, std::size_t most);

/// Date and time in UTC of a time since 1970 [ns].
std::string utc(std::int64_t time);

}  // namespace self_awareness::ros1
