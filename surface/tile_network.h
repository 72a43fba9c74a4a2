// surface/tile_network.h - which corners of a tile's cells a surface within a bound needs.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>

#include "surface/height_grid.h"

namespace kerf {

/// A right-triangulated network over the corners of a tile's cells. The whole square is halved
/// along its diagonal, and each triangle again from its right angle to the middle of its longest
/// edge, as far as it takes:
///
///      D-------C      D-------C      D-------C
///      |     / |      | \   / |      | \ | / |      C-A is split at the square's middle,
///      |   /   |  ->  |   c   |  ->  e---c---e      then D-A at the middle e of an edge,
///      | /     |      | /   \ |      | / | \ |      then the four squares of half the edge.
///      A-------B      A-------B      A-------B
///
/// Both triangles at an edge are split together, so there are no cracks; nor are there any between
/// tiles, once each has been told what its neighbours need of the rim that they share (add_rim).
/// Source: W. Evans, D. Kirkpatrick, G. Townsend, "Right-triangulated irregular networks",
/// Algorithmica 30, 2001.
///
/// The bound is exact, measured up and down: edges of the network run along lines of cells or
/// through opposite corners of them, so the two surfaces are farthest apart at a corner of a cell,
/// or in the middle of one through which an edge runs.
class TileNetwork {
 public:
  static constexpr int kCells = HeightGrid::kTileCells;
  static constexpr int kLine = kCells + 1;  ///< corners in a row
  enum class Cell : std::uint8_t {
    kFree,  ///< may be part of a larger triangle
    kKept,  ///< stays as it is; so do those without material beside others with
    kVoid,  ///< has no material
  };
  /// The surface in full.
  struct Lattice {
    std::array<float, std::size_t{kLine} * kLine> z;         ///< by corner
    std::array<float, std::size_t{kCells} * kCells> middle;  ///< by cell
    std::array<Cell, std::size_t{kCells} * kCells> cell;
    static std::size_t corner(int i, int j) { return static_cast<std::size_t>(j * kLine + i); }
    static std::size_t at(int i, int j) { return static_cast<std::size_t>(j * kCells + i); }
  };
  enum class Side : std::uint8_t { kLeft, kRight, kLow, kHigh };

  TileNetwork() = default;
  /// Nowhere farther than `most_mm` from the surface in full. About 30 us.
  TileNetwork(const Lattice& lattice, float most_mm);

  bool needs(int i, int j) const {
    return needs_[Lattice::corner(i, j)] || (i % kCells == 0 && j % kCells == 0);
  }
  /// Bit k: corner k of the side, 0 < k < kCells.
  std::uint64_t rim(Side side) const;
  /// Corners that a neighbour needs. True: others are needed for them that were not; then rims may
  /// have changed.
  bool add_rim(Side side, std::uint64_t corners);

  /// Calls cell(i, j) for each cell that is as it was, and triangle(a, b, c), counter-clockwise
  /// seen from above, for all else; not where `is_void(i, j)` says that a cell is none.
  template <class IsVoid, class OfCell, class OfTriangle>
  void each(const IsVoid& is_void, const OfCell& cell, const OfTriangle& triangle) const {
    constexpr int n = kCells;
    const Emitter<IsVoid, OfCell, OfTriangle> emit{is_void, cell, triangle};
    walk(emit, {n, n}, {0, 0}, {n, 0});
    walk(emit, {0, 0}, {n, n}, {0, n});
  }

  struct Corner {
    int i, j;
  };

 private:
  template <class IsVoid, class OfCell, class OfTriangle>
  struct Emitter {
    const IsVoid& is_void;
    const OfCell& cell;
    const OfTriangle& triangle;
  };

  /// The triangle with this longest edge and right angle.
  template <class Emit>
  void walk(const Emit& emit, Corner a, Corner b, Corner right) const {
    const int di = b.i - a.i, dj = b.j - a.j;
    if (di * di + dj * dj == 2) {
      const int i = a.i < b.i ? a.i : b.i, j = a.j < b.j ? a.j : b.j;
      if (emit.is_void(i, j)) return;
      // Where its fourth corner is needed, the cell's other half is a triangle by itself, too.
      if (!needs(2 * i + 1 - right.i, 2 * j + 1 - right.j))
        emit.triangle(a, b, right);
      else if (right.j == j)
        emit.cell(i, j);
      return;
    }
    const Corner middle{(a.i + b.i) / 2, (a.j + b.j) / 2};
    if (needs(middle.i, middle.j)) {
      walk(emit, right, a, middle);
      walk(emit, b, right, middle);
    } else if (!emit.is_void((a.i + b.i + right.i) / 3, (a.j + b.j + right.j) / 3)) {
      emit.triangle(a, b, right);
    }
  }
  void set(int i, int j) { needs_[Lattice::corner(i, j)] = true; }
  /// What is split for the sake of what lies within. With a lattice, measures the others.
  void complete(const Lattice* lattice, float most_mm);
  bool needs_below_edge(Corner middle, int half, bool along_x) const;

  std::bitset<std::size_t{kLine} * kLine> needs_;
};

}  // namespace kerf
