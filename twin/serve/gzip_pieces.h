// twin/serve/gzip_pieces.h - answers of pieces that are compressed once, whoever gets them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace kerf {

/// A text as blocks of DEFLATE (RFC 1951) that end on a byte, refer to nothing before them, and are
/// not the last: they may stand behind any others.
struct GzipPiece {
  std::string blocks;
  std::uint32_t crc = 0;    ///< of the text
  std::uint64_t bytes = 0;  ///< that it has
};

/// The fastest of zlib's levels: 10 kB take about 0.1 ms.
GzipPiece gzip_piece(std::string_view text);

/// The texts one behind the other as a gzip file (RFC 1952).
std::string gzip_of(std::span<const GzipPiece* const> pieces);

}  // namespace kerf
