#include "stock/pieces/bit_plane.h"

namespace kerf {
namespace {

constexpr std::uint64_t kLast = std::uint64_t{1} << 63;

/// `bits` and all that hangs together with them in `within`, of one word.
std::uint64_t filled(std::uint64_t bits, std::uint64_t within) {
  std::uint64_t up = bits, down = bits, way_up = within, way_down = within;
  for (int step = 1; step < 64; step *= 2) {
    up |= way_up & (up << step);
    way_up &= way_up << step;
    down |= way_down & (down >> step);
    way_down &= way_down >> step;
  }
  return up | down;
}

}  // namespace

std::size_t count_of(const CellSet& cells) {
  std::size_t count = 0;
  for (const CellWord& c : cells) count += static_cast<std::size_t>(std::popcount(c.bits));
  return count;
}

CellSet BitPlane::all() const {
  CellSet out;
  for (int row = 0; row < ny_; ++row) {
    for (int word = 0; word < words_; ++word) {
      if (const std::uint64_t bits = at(row, word)) out.push_back({row, word, bits});
    }
  }
  return out;
}

bool flood(const BitPlane& within, BitPlane& mark, const CellSet& seeds, std::size_t most_words,
           CellSet& found, CellSet& open) {
  open.clear();
  const auto visit = [&](int row, int word, std::uint64_t bits) {
    if (!within.has(row, word)) return;
    const std::uint64_t fresh = bits & within.at(row, word) & ~mark.at(row, word);
    if (fresh != 0) open.push_back({row, word, fresh});
  };
  for (const CellWord& seed : seeds) visit(seed.row, seed.word, seed.bits);
  std::size_t words = 0;
  while (!open.empty()) {
    const CellWord at = open.back();
    open.pop_back();
    std::uint64_t& done = mark.at(at.row, at.word);
    const std::uint64_t fresh = filled(at.bits, within.at(at.row, at.word)) & ~done;
    if (fresh == 0) continue;
    if (++words > most_words) return false;
    done |= fresh;
    found.push_back({at.row, at.word, fresh});
    const std::uint64_t around = fresh | fresh << 1 | fresh >> 1;
    for (int row = at.row - 1; row <= at.row + 1; ++row) {
      if (row != at.row) visit(row, at.word, around);
      if (fresh & 1) visit(row, at.word - 1, kLast);
      if (fresh & kLast) visit(row, at.word + 1, 1);
    }
  }
  return true;
}

bool has_square(const CellSet& cells, BitPlane& scratch) {
  scratch.add(cells);
  const bool found = std::ranges::any_of(cells, [&](const CellWord& c) {
    if (c.row + 1 >= scratch.ny()) return false;
    const auto pairs = [&](int row) {
      const std::uint64_t bits = scratch.at(row, c.word);
      const std::uint64_t next = c.word + 1 < scratch.words() ? scratch.at(row, c.word + 1) & 1 : 0;
      return bits & (bits >> 1 | next << 63);
    };
    return (pairs(c.row) & pairs(c.row + 1)) != 0;
  });
  scratch.remove(cells);
  return found;
}

}  // namespace kerf
