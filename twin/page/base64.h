// twin/page/base64.h - bytes as a page holds them.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace kerf {

/// RFC 4648, with padding.
std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace kerf
