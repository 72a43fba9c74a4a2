// stock/pieces/bit_plane.h - yes or no for each cell of a grid seen from above, 64 cells at a time.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace kerf {

/// Cells of a row: bit b of `bits` is cell (64 * word + b, row).
struct CellWord {
  int row = 0, word = 0;
  std::uint64_t bits = 0;
};
/// No cell is in it twice.
using CellSet = std::vector<CellWord>;

std::size_t count_of(const CellSet& cells);
/// Calls see(i, j) for each cell.
template <class See>
void each_cell(const CellSet& cells, const See& see) {
  for (const CellWord& at : cells) {
    for (std::uint64_t bits = at.bits; bits != 0; bits &= bits - 1)
      see(64 * at.word + std::countr_zero(bits), at.row);
  }
}

/// nx x ny bits, all 0 at first. What is beyond counts as 0.
class BitPlane {
 public:
  BitPlane() = default;
  BitPlane(int nx, int ny)
      : nx_(nx),
        ny_(ny),
        words_((nx + 63) / 64),
        bits_(static_cast<std::size_t>(words_) * static_cast<std::size_t>(ny)) {}

  int nx() const { return nx_; }
  int ny() const { return ny_; }
  int words() const { return words_; }  ///< in a row
  std::uint64_t& at(int row, int word) { return bits_[index(row, word)]; }
  std::uint64_t at(int row, int word) const { return bits_[index(row, word)]; }
  bool has(int row, int word) const { return row >= 0 && row < ny_ && word >= 0 && word < words_; }
  bool test(int i, int j) const { return at(j, i / 64) >> (i % 64) & 1; }
  void set(int i, int j) { at(j, i / 64) |= std::uint64_t{1} << (i % 64); }
  void add(const CellSet& cells) {
    for (const CellWord& c : cells) at(c.row, c.word) |= c.bits;
  }
  void remove(const CellSet& cells) {
    for (const CellWord& c : cells) at(c.row, c.word) &= ~c.bits;
  }
  bool meets(const CellSet& cells) const {
    return std::ranges::any_of(
        cells, [this](const CellWord& c) { return (at(c.row, c.word) & c.bits) != 0; });
  }
  CellSet all() const;

 private:
  std::size_t index(int row, int word) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(words_) +
           static_cast<std::size_t>(word);
  }
  int nx_ = 0, ny_ = 0, words_ = 0;
  std::vector<std::uint64_t> bits_;
};

/// Appends to `found` what hangs together with `seeds` among the bits of `within`: cells that share
/// a side or a corner. Marks it in `mark`, and takes for done what is marked there. False: it is
/// more than `most_words`, and not all of it has been found. `open` is room that is used again.
bool flood(const BitPlane& within, BitPlane& mark, const CellSet& seeds, std::size_t most_words,
           CellSet& found, CellSet& open);
inline bool flood(const BitPlane& within, BitPlane& mark, const CellSet& seeds,
                  std::size_t most_words, CellSet& found) {
  CellSet open;
  return flood(within, mark, seeds, most_words, found, open);
}

/// Whether a square of 2 x 2 cells is in it. What is thinner than a cell never has one, what is
/// thicker than 3 cells always. `scratch`: all 0, and left so.
bool has_square(const CellSet& cells, BitPlane& scratch);

}  // namespace kerf
