#include "twin/serve/gzip_pieces.h"

#include <zlib.h>

#include <cassert>

namespace kerf {
namespace {

constexpr int kRawWindowBits = -15, kMemoryLevel = 8;
/// Of nobody's computer, without a time or a name.
constexpr std::string_view kGzipHead{"\x1f\x8b\x08\0\0\0\0\0\0\xff", 10};
/// The last block, of nothing.
constexpr std::string_view kLastBlock{"\x03\0", 2};

void put_four(std::string& out, std::uint64_t value) {
  for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>(value >> shift & 0xffU);
}

Bytef* bytes_of(const char* text) {
  // zlib does not write there.
  return reinterpret_cast<Bytef*>(const_cast<char*>(text));
}

}  // namespace

GzipPiece gzip_piece(std::string_view text) {
  GzipPiece piece;
  piece.bytes = text.size();
  piece.crc = static_cast<std::uint32_t>(
      crc32(crc32(0, nullptr, 0), bytes_of(text.data()), static_cast<uInt>(text.size())));
  z_stream stream{};
  [[maybe_unused]] int said = deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, kRawWindowBits,
                                           kMemoryLevel, Z_DEFAULT_STRATEGY);
  assert(said == Z_OK);
  piece.blocks.resize(deflateBound(&stream, static_cast<uLong>(text.size())) + 16);
  stream.next_in = bytes_of(text.data());
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = bytes_of(piece.blocks.data());
  stream.avail_out = static_cast<uInt>(piece.blocks.size());
  said = deflate(&stream, Z_SYNC_FLUSH);
  assert(said == Z_OK && stream.avail_in == 0 && stream.avail_out > 0);
  piece.blocks.resize(stream.total_out);
  deflateEnd(&stream);
  return piece;
}

std::string gzip_of(std::span<const GzipPiece* const> pieces) {
  std::string out(kGzipHead);
  uLong crc = crc32(0, nullptr, 0);
  std::uint64_t bytes = 0;
  for (const GzipPiece* piece : pieces) {
    out += piece->blocks;
    crc = crc32_combine(crc, piece->crc, static_cast<z_off_t>(piece->bytes));
    bytes += piece->bytes;
  }
  out += kLastBlock;
  put_four(out, crc);
  put_four(out, bytes);
  return out;
}

}  // namespace kerf
