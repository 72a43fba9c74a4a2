#include "stock/zmap/packed_tile.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "stock/zmap/sweep_ops.h"

namespace kerf {
namespace {

using Word = std::uint32_t;

constexpr std::size_t kGroup = 64;  ///< cells that have one width
constexpr std::size_t kRow = std::size_t{kTileBlocksX} * kBlockFloats;
constexpr std::size_t kBlock = kBlockFloats;
static_assert(kRow % kGroup == 0 && kTileFloats % kRow == 0);
constexpr std::size_t kGroups = kTileFloats / kGroup;
/// Two bytes of each group: its width and kind, and how many values are wider than that.
constexpr std::size_t kHeads = 2 * kGroups;
constexpr unsigned kKindShift = 6;
/// What the wider ones have beyond the width takes four bytes each, else two.
constexpr unsigned kIsLong = 0x80;
/// A value is read and written in words of 64 bits, the last one too.
constexpr std::size_t kSpare = 8;

/// What a cell is told from.
enum class Kind : std::uint8_t { kLeft, kLeftBelow, kLine };
constexpr std::size_t kKinds = 3;

/// So that numbers of either sign near 0 are small ones.
constexpr Word zigzag(Word d) { return (d << 1) ^ (0 - (d >> 31)); }
constexpr Word straight(Word z) { return (z >> 1) ^ (0 - (z & 1)); }
/// Bits of heights in the order of the heights; its own inverse.
constexpr Word in_order(Word bits) {
  return bits ^ (static_cast<Word>(static_cast<std::int32_t>(bits) >> 31) >> 1);
}

/// Room for the cells of a tile, with what stands to the left of it and below it: zeros.
struct Field {
  static constexpr std::size_t kMargin = 2 * kBlock;
  static constexpr std::size_t kPitch = kRow + kMargin;
  alignas(32) std::array<Word, kPitch*(kTileBlocksY + 1)> cells{};
  Word* row(std::size_t r) { return cells.data() + (r + 1) * kPitch + kMargin; }
};

template <Kind kKind>
Word told(const Word* at) {
  if constexpr (kKind == Kind::kLeft) return at[-std::ptrdiff_t{kBlock}];
  if constexpr (kKind == Kind::kLine) {
    return 2 * at[-std::ptrdiff_t{kBlock}] - at[-std::ptrdiff_t{2 * kBlock}];
  }
  const Word* const below = at - Field::kPitch;
  return at[-std::ptrdiff_t{kBlock}] + below[0] - below[-std::ptrdiff_t{kBlock}];
}

/// Returns how large the rests are, where a few large ones do not count for more than they cost.
template <Kind kKind>
Word rest_of(const Word* at, std::array<Word, kGroup>& rest) {
  constexpr Word kMost = 1u << 20;
  Word sum = 0;
  for (std::size_t k = 0; k < kGroup; ++k) {
    rest[k] = zigzag(at[k] - told<kKind>(at + k));
    sum += rest[k] < kMost ? rest[k] : kMost;
  }
  return sum;
}

/// The fewest bytes: of all values so many bits, of the few that are wider the others, too.
struct Width {
  unsigned bits = 0;
  unsigned wider = 0;
  bool is_long = false;
};
Width width_of(const std::array<Word, kGroup>& values) {
  std::array<unsigned, 33> count{};
  for (const Word value : values) ++count[static_cast<std::size_t>(std::bit_width(value))];
  unsigned most = 32;
  while (most > 0 && count[most] == 0) --most;
  Width best{most, 0, false};
  std::size_t least = most * kGroup / 8;
  unsigned wider = 0;
  for (unsigned bits = most; bits-- > 0;) {
    wider += count[bits + 1];
    const bool is_long = most - bits > 16;
    const std::size_t bytes = bits * kGroup / 8 + wider * (is_long ? 5 : 3);
    if (bytes >= least) continue;
    least = bytes;
    best = {bits, wider, is_long};
  }
  return best;
}

std::uint8_t* write_wider(const std::array<Word, kGroup>& values, const Width& width,
                          std::uint8_t* out) {
  for (std::size_t k = 0; k < kGroup; ++k) {
    const auto beyond = static_cast<Word>(std::uint64_t{values[k]} >> width.bits);
    if (beyond == 0) continue;
    *out++ = static_cast<std::uint8_t>(k);
    const std::size_t bytes = width.is_long ? 4 : 2;
    for (std::size_t n = 0; n < bytes; ++n) *out++ = static_cast<std::uint8_t>(beyond >> 8 * n);
  }
  return out;
}

const std::uint8_t* read_wider(const std::uint8_t* in, const Width& width,
                               std::array<Word, kGroup>& values) {
  for (unsigned i = 0; i < width.wider; ++i) {
    const std::size_t k = *in++;
    const std::size_t bytes = width.is_long ? 4 : 2;
    Word beyond = 0;
    for (std::size_t n = 0; n < bytes; ++n) beyond |= Word{*in++} << 8 * n;
    values[k] |= beyond << width.bits;
  }
  return in;
}

/// Appends the bits of a group, least first.
std::uint8_t* write_bits(const std::array<Word, kGroup>& values, unsigned width,
                         std::uint8_t* out) {
  const Word mask = static_cast<Word>((std::uint64_t{1} << width) - 1);
  std::uint64_t waiting = 0;
  unsigned count = 0;
  for (const Word value : values) {
    waiting |= std::uint64_t{value & mask} << count;
    count += width;
    if (count < 32) continue;
    const Word low = static_cast<Word>(waiting);
    std::memcpy(out, &low, sizeof low);
    out += sizeof low;
    waiting >>= 32;
    count -= 32;
  }
  return out;  // 64 values of any width end with a word
}

const std::uint8_t* read_bits(const std::uint8_t* in, unsigned width,
                              std::array<Word, kGroup>& values) {
  const std::uint64_t mask = (std::uint64_t{1} << width) - 1;
  for (std::size_t k = 0; k < kGroup; ++k) {
    const std::size_t bit = k * width;
    std::uint64_t word = 0;
    std::memcpy(&word, in + bit / 8, sizeof word);
    values[k] = static_cast<Word>((word >> (bit % 8)) & mask);
  }
  return in + width * kGroup / 8;
}

template <Kind kKind>
void fill_in(const std::array<Word, kGroup>& rest, Word* at) {
  // A block after the other: each is told from the one before it.
  for (std::size_t first = 0; first < kGroup; first += kBlock) {
    for (std::size_t k = first; k < first + kBlock; ++k) {
      at[k] = straight(rest[k]) + told<kKind>(at + k);
    }
  }
}

std::uint8_t* pack(Field& field, std::uint8_t* out) {
  std::uint8_t* heads = out;
  out += kHeads;
  std::array<std::array<Word, kGroup>, kKinds> rests;
  for (std::size_t r = 0; r < kTileBlocksY; ++r) {
    for (std::size_t x = 0; x < kRow; x += kGroup) {
      const Word* const at = field.row(r) + x;
      const std::array<Word, kKinds> size{rest_of<Kind::kLeft>(at, rests[0]),
                                          rest_of<Kind::kLeftBelow>(at, rests[1]),
                                          rest_of<Kind::kLine>(at, rests[2])};
      const auto best =
          static_cast<std::size_t>(std::min_element(size.begin(), size.end()) - size.begin());
      const Width width = width_of(rests[best]);
      *heads++ = static_cast<std::uint8_t>(width.bits | best << kKindShift);
      *heads++ = static_cast<std::uint8_t>(width.wider | (width.is_long ? kIsLong : 0));
      out = write_bits(rests[best], width.bits, out);
      if (width.wider > 0) out = write_wider(rests[best], width, out);
    }
  }
  return out;
}

const std::uint8_t* unpack(const std::uint8_t* in, Field& field) {
  const std::uint8_t* heads = in;
  in += kHeads;
  std::array<Word, kGroup> rest;
  for (std::size_t r = 0; r < kTileBlocksY; ++r) {
    for (std::size_t x = 0; x < kRow; x += kGroup) {
      const unsigned head = *heads++, tail = *heads++;
      const Width width{head & ((1u << kKindShift) - 1), tail & (kIsLong - 1),
                        (tail & kIsLong) != 0};
      in = read_bits(in, width.bits, rest);
      if (width.wider > 0) in = read_wider(in, width, rest);
      Word* const at = field.row(r) + x;
      switch (static_cast<Kind>(head >> kKindShift)) {
        case Kind::kLeft:
          fill_in<Kind::kLeft>(rest, at);
          break;
        case Kind::kLeftBelow:
          fill_in<Kind::kLeftBelow>(rest, at);
          break;
        case Kind::kLine:
          fill_in<Kind::kLine>(rest, at);
          break;
      }
    }
  }
  return in;
}

}  // namespace

PackedTile::PackedTile(const float* cells, bool has_cut_ids) : has_cut_ids_(has_cut_ids) {
  constexpr std::size_t kMost = kHeads + kTileFloats * sizeof(Word);
  static thread_local std::array<std::uint8_t, 2 * kMost> room;
  static thread_local Field field;
  std::uint8_t* end = room.data();
  for (std::size_t r = 0; r < kTileBlocksY; ++r) {
    std::memcpy(field.row(r), cells + r * kRow, kRow * sizeof(Word));
    for (std::size_t k = 0; k < kRow; ++k) field.row(r)[k] = in_order(field.row(r)[k]);
  }
  end = pack(field, end);
  if (has_cut_ids) {
    for (std::size_t r = 0; r < kTileBlocksY; ++r) {
      std::memcpy(field.row(r), cut_ids_of(cells) + r * kRow, kRow * sizeof(Word));
    }
    end = pack(field, end);
  }
  data_.reserve(static_cast<std::size_t>(end - room.data()) + kSpare);
  data_.assign(room.data(), end);
  data_.resize(data_.size() + kSpare);
}

void PackedTile::unpack(float* cells) const {
  static thread_local Field field;
  const std::uint8_t* rest = kerf::unpack(data_.data(), field);
  for (std::size_t r = 0; r < kTileBlocksY; ++r) {
    for (std::size_t k = 0; k < kRow; ++k) field.row(r)[k] = in_order(field.row(r)[k]);
    std::memcpy(cells + r * kRow, field.row(r), kRow * sizeof(Word));
  }
  if (!has_cut_ids_) return;
  kerf::unpack(rest, field);
  for (std::size_t r = 0; r < kTileBlocksY; ++r) {
    std::memcpy(cut_ids_of(cells) + r * kRow, field.row(r), kRow * sizeof(Word));
  }
}

}  // namespace kerf
