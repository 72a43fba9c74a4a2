#include "twin/program/motion_archive.h"

#include <array>
#include <bit>
#include <cstring>
#include <type_traits>

namespace kerf {
namespace {

static_assert(std::is_trivially_copyable_v<Motion>);
static_assert(sizeof(Motion) % sizeof(std::uint64_t) == 0);
constexpr std::size_t kWords = sizeof(Motion) / sizeof(std::uint64_t);
constexpr std::size_t kMasks = (kWords + 63) / 64;
using Words = std::array<std::uint64_t, kWords>;

/// What the motion after `last` most likely begins with: where that ended.
Words expected_after(const Motion& last) {
  Motion next = last;
  next.from_mm = last.to_mm;
  next.from_abc_deg = last.to_abc_deg;
  next.from_uvw_mm = last.to_uvw_mm;
  Words words;
  std::memcpy(words.data(), &next, sizeof next);
  return words;
}

}  // namespace

const Motion& MotionArchive::before_first() {
  static const Motion motion;
  return motion;
}

/// For each motion a bit a word that differs, and those words.
void MotionArchive::append(std::span<const Motion> motions) {
  for (const Motion& motion : motions) {
    const Words expected = expected_after(last_);
    Words words;
    std::memcpy(words.data(), &motion, sizeof motion);
    const std::size_t mask_at = words_.size();
    words_.resize(mask_at + kMasks);
    for (std::size_t i = 0; i < kWords; ++i) {
      if (words[i] == expected[i]) continue;
      words_[mask_at + i / 64] |= std::uint64_t{1} << (i % 64);
      words_.push_back(words[i]);
    }
    last_ = motion;
  }
  size_ += motions.size();
}

void MotionArchive::Reader::take(std::size_t count, std::vector<Motion>& out) {
  const std::vector<std::uint64_t>& from = archive_.words_;
  for (; count > 0; --count) {
    Words words = expected_after(last_);
    const std::size_t mask_at = at_;
    at_ += kMasks;
    for (std::size_t block = 0; block < kMasks; ++block) {
      for (std::uint64_t mask = from[mask_at + block]; mask != 0; mask &= mask - 1) {
        words[block * 64 + static_cast<std::size_t>(std::countr_zero(mask))] = from[at_++];
      }
    }
    last_ = std::bit_cast<Motion>(words);
    out.push_back(last_);
  }
}

}  // namespace kerf
