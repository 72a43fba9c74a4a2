// twin/playback/packed_column.h - millions of numbers of one kind, small and at hand.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace kerf {

/// Appended one by one, read in any order, given back bit for bit (-0 and NaN too). Numbers are
/// packed in blocks of kBlock: one that never changes takes nothing but the block's head, whole
/// numbers and decimals of four places (what NC programs are written in) as many bytes as their
/// range within the block needs, and all others as many as that of their bits, up to eight.
class PackedColumn {
 public:
  enum class Of : std::uint8_t { kIntegers, kReals };
  static constexpr std::size_t kBlock = 256;

  explicit PackedColumn(Of of) : of_(of) {}

  void push(std::uint64_t value);
  void push_real(double value) { push(std::bit_cast<std::uint64_t>(value)); }

  /// O(1).
  std::uint64_t at(std::size_t i) const;
  double real_at(std::size_t i) const { return std::bit_cast<double>(at(i)); }

  std::size_t size() const { return heads_.size() * kBlock + open_count_; }
  /// Gives back what growing has reserved.
  void shrink();
  /// Memory, the open block included.
  std::size_t bytes() const;

 private:
  /// A packed block. Value i of it is `base` plus the number of `width` bytes at
  /// data_[offset + i * width]: as it stands, or, if `decimal`, as so many ten-thousandths.
  struct Head {
    std::uint64_t base = 0;
    std::uint32_t offset = 0;  ///< in units of kUnit bytes
    std::uint8_t width = 0;    ///< 0 to 8
    bool decimal = false;
  };
  static constexpr std::size_t kUnit = 256;

  void close_block();
  bool pack_decimals();
  void pack(const std::array<std::uint64_t, kBlock>& values, bool decimal);

  Of of_;
  std::size_t open_count_ = 0;
  std::array<std::uint64_t, kBlock> open_{};  ///< the last numbers, not packed yet
  std::vector<Head> heads_;
  std::vector<std::uint8_t> data_;
};

}  // namespace kerf
