// twin/page/html_text.h - text and bytes as a page holds them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace kerf {

/// For text and for values of attributes in double quotes. Control characters but newline and tab
/// become U+FFFD, and so do bytes that are no UTF-8.
std::string html_text(std::string_view text);

/// The same bytes but for those that are no UTF-8, which become U+FFFD.
std::string valid_utf8(std::string_view text);

/// RFC 4648, with padding.
std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace kerf
