#include "twin/playback/packed_column.h"

#include <algorithm>
#include <cmath>

namespace kerf {
namespace {

/// NC programs are written in ten-thousandths.
constexpr double kDecimals = 1e4;
/// Beyond this a number of ten-thousandths is not exact in double any more.
constexpr double kMostDecimals = 9e15;

std::uint8_t width_of(std::uint64_t range) {
  return static_cast<std::uint8_t>((std::bit_width(range) + 7) / 8);
}

double from_decimals(std::uint64_t count) {
  return static_cast<double>(static_cast<std::int64_t>(count)) / kDecimals;
}

}  // namespace

void PackedColumn::push(std::uint64_t value) {
  open_[open_count_++] = value;
  if (open_count_ == kBlock) close_block();
}

void PackedColumn::close_block() {
  if (of_ == Of::kIntegers || !pack_decimals()) pack(open_, false);
  open_count_ = 0;
}

/// False: a number is none of ten-thousandths.
bool PackedColumn::pack_decimals() {
  if (std::all_of(open_.begin(), open_.end(), [&](std::uint64_t v) { return v == open_[0]; })) {
    return false;  // packs to nothing as it is
  }
  std::array<std::uint64_t, kBlock> counts;
  for (std::size_t i = 0; i < kBlock; ++i) {
    const double scaled = std::bit_cast<double>(open_[i]) * kDecimals;
    if (!(std::abs(scaled) < kMostDecimals)) return false;
    counts[i] = static_cast<std::uint64_t>(std::llround(scaled));
    if (std::bit_cast<std::uint64_t>(from_decimals(counts[i])) != open_[i]) return false;
  }
  pack(counts, true);
  return true;
}

void PackedColumn::pack(const std::array<std::uint64_t, kBlock>& values, bool decimal) {
  Head head;
  head.decimal = decimal;
  // Decimals may be negative; as unsigned numbers their differences come out right all the same.
  const auto less = [decimal](std::uint64_t a, std::uint64_t b) {
    return decimal ? static_cast<std::int64_t>(a) < static_cast<std::int64_t>(b) : a < b;
  };
  const auto [least, most] = std::minmax_element(values.begin(), values.end(), less);
  head.base = *least;
  head.width = width_of(*most - *least);
  head.offset = static_cast<std::uint32_t>(data_.size() / kUnit);
  data_.resize(data_.size() + kBlock * head.width);
  std::uint8_t* to = data_.data() + std::size_t{head.offset} * kUnit;
  for (const std::uint64_t value : values) {
    const std::uint64_t delta = value - head.base;
    for (std::uint8_t byte = 0; byte < head.width; ++byte) {
      *to++ = static_cast<std::uint8_t>(delta >> (8 * byte));
    }
  }
  heads_.push_back(head);
}

std::uint64_t PackedColumn::at(std::size_t i) const {
  const std::size_t block = i / kBlock;
  if (block == heads_.size()) return open_[i % kBlock];
  const Head& head = heads_[block];
  const std::uint8_t* from =
      data_.data() + std::size_t{head.offset} * kUnit + (i % kBlock) * head.width;
  std::uint64_t delta = 0;
  for (std::uint8_t byte = 0; byte < head.width; ++byte) {
    delta |= static_cast<std::uint64_t>(from[byte]) << (8 * byte);
  }
  const std::uint64_t value = head.base + delta;
  return head.decimal ? std::bit_cast<std::uint64_t>(from_decimals(value)) : value;
}

void PackedColumn::shrink() {
  heads_.shrink_to_fit();
  data_.shrink_to_fit();
}

std::size_t PackedColumn::bytes() const {
  return sizeof *this + heads_.capacity() * sizeof(Head) + data_.capacity();
}

}  // namespace kerf
