#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace self_awareness::ros1 {

/// Whether the bytes are UTF-8, as of RFC 3629: no other program can be handed anything else.
bool isUtf8(std::string_view bytes);

/// Bytes of a stranger as text that every program can read and every terminal can show: what is no
/// UTF-8, and each control character, becomes U+FFFD.
/// @param most so many bytes are read; a character that this cuts is left out
std::string printable(std::string_view bytes, std::size_t most = std::string_view::npos);

}  // namespace self_awareness::ros1
