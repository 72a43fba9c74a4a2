#include "surface/tile_network.h"

#include <algorithm>
#include <cmath>

namespace kerf {
namespace {

using Lattice = TileNetwork::Lattice;
constexpr int kCells = TileNetwork::kCells;

/// A plane over a triangle, along two of its directions.
struct Plane {
  float z, along, across;
  float at(float u, float v) const { return z + u * along + v * across; }
};

/// A way over the corners: `u` steps along, `v` across.
class Frame {
 public:
  Frame(const Lattice& lattice, TileNetwork::Corner from, int di, int dj, bool swaps)
      : lattice_(lattice), from_(from), di_(di), dj_(dj), swaps_(swaps) {}

  const float* corner(int u, int v) const {
    const int i = from_.i + di_ * (swaps_ ? v : u), j = from_.j + dj_ * (swaps_ ? u : v);
    return lattice_.z.data() + Lattice::corner(i, j);
  }
  int step() const { return swaps_ ? dj_ * TileNetwork::kLine : di_; }
  /// Middle of the cell between (u, v) and (u + 1, v + 1).
  float middle(int u, int v) const { return lattice_.middle[cell(u, v)]; }
  bool is_void(int u, int v) const { return lattice_.cell[cell(u, v)] == TileNetwork::Cell::kVoid; }

 private:
  std::size_t cell(int u, int v) const {
    const int i = swaps_ ? v : u, j = swaps_ ? u : v;
    return Lattice::at(di_ > 0 ? from_.i + i : from_.i - i - 1,
                       dj_ > 0 ? from_.j + j : from_.j - j - 1);
  }

  const Lattice& lattice_;
  TileNetwork::Corner from_;
  int di_, dj_;
  bool swaps_;
};

/// Corners u0 .. u1 of row v.
bool leaves_row(const Frame& frame, const Plane& plane, int u0, int u1, int v, float most_mm) {
  const float* const z = frame.corner(u0, v);
  const int step = frame.step();
  float worst = 0;
  for (int k = 0; k <= u1 - u0; ++k) {
    const float off = z[k * step] - plane.at(static_cast<float>(u0 + k), static_cast<float>(v));
    worst = std::max(worst, std::abs(off));
  }
  return worst > most_mm;
}

bool leaves_middle(const Frame& frame, const Plane& plane, int u, int v, float most_mm) {
  const float off =
      frame.middle(u, v) - plane.at(static_cast<float>(u) + 0.5f, static_cast<float>(v) + 0.5f);
  return std::abs(off) > most_mm;
}

/// A right angle at `frame`'s begin, with sides of `size` along both directions.
bool leaves_half_square(const Frame& frame, int size, float most_mm) {
  if (frame.is_void(0, 0)) return false;
  const float z = *frame.corner(0, 0), per = 1.0f / static_cast<float>(size);
  const Plane plane{z, (*frame.corner(size, 0) - z) * per, (*frame.corner(0, size) - z) * per};
  for (int k = 0; k < size; ++k)
    if (leaves_middle(frame, plane, k, size - 1 - k, most_mm)) return true;
  for (int v = 0; v <= size; ++v)
    if (leaves_row(frame, plane, 0, size - v, v, most_mm)) return true;
  return false;
}

/// The longest edge is `size` long from `frame`'s begin, the right angle half as far across from
/// its middle.
bool leaves_quarter_square(const Frame& frame, int size, float most_mm) {
  const int half = size / 2;
  if (frame.is_void(half - 1, 0)) return false;
  const float a = *frame.corner(0, 0), b = *frame.corner(size, 0), c = *frame.corner(half, half);
  const Plane plane{a, (b - a) / static_cast<float>(size),
                    (c - (a + b) / 2) / static_cast<float>(half)};
  for (int k = 0; k < half; ++k) {
    if (leaves_middle(frame, plane, k, k, most_mm) ||
        leaves_middle(frame, plane, size - 1 - k, k, most_mm))
      return true;
  }
  for (int v = 0; v <= half; ++v)
    if (leaves_row(frame, plane, v, size - v, v, most_mm)) return true;
  return false;
}

/// The triangles at an edge of a square along x, or along y.
bool leaves_at_edge(const Lattice& lattice, TileNetwork::Corner from, int size, bool along_x,
                    float most_mm) {
  for (const int across : {1, -1}) {
    if (across < 0 ? (along_x ? from.j : from.i) == 0 : (along_x ? from.j : from.i) == kCells)
      continue;
    const Frame frame(lattice, from, along_x ? 1 : across, along_x ? across : 1, !along_x);
    if (leaves_quarter_square(frame, size, most_mm)) return true;
  }
  return false;
}

/// The two halves of a square.
bool leaves_in_square(const Lattice& lattice, TileNetwork::Corner from, int size, float most_mm) {
  // Diagonals of the four squares of a larger one meet in its middle.
  const bool is_rising = size == kCells || (from.i / size + from.j / size) % 2 == 0;
  if (is_rising) {
    return leaves_half_square(Frame(lattice, {from.i + size, from.j}, -1, 1, false), size,
                              most_mm) ||
           leaves_half_square(Frame(lattice, {from.i, from.j + size}, 1, -1, false), size, most_mm);
  }
  return leaves_half_square(Frame(lattice, from, 1, 1, false), size, most_mm) ||
         leaves_half_square(Frame(lattice, {from.i + size, from.j + size}, -1, -1, false), size,
                            most_mm);
}

}  // namespace

TileNetwork::TileNetwork(const Lattice& lattice, float most_mm) {
  for (int j = 0; j < kCells; ++j) {
    for (int i = 0; i < kCells; ++i) {
      if (lattice.cell[Lattice::at(i, j)] != Cell::kKept) continue;
      set(i, j);
      set(i + 1, j);
      set(i, j + 1);
      set(i + 1, j + 1);
    }
  }
  complete(&lattice, most_mm);
}

/// What is needed in the middle of the squares of `half` at both sides of the edge.
bool TileNetwork::needs_below_edge(Corner middle, int half, bool along_x) const {
  if (half < 2) return false;
  const int quarter = half / 2;
  for (const int along : {-quarter, quarter}) {
    for (const int across : {-quarter, quarter}) {
      const int i = middle.i + (along_x ? along : across),
                j = middle.j + (along_x ? across : along);
      if (i > 0 && j > 0 && i < kCells && j < kCells && needs(i, j)) return true;
    }
  }
  return false;
}

void TileNetwork::complete(const Lattice* lattice, float most_mm) {
  for (int size = 2; size <= kCells; size *= 2) {
    const int half = size / 2;
    for (const bool along_x : {true, false}) {
      for (int across = 0; across <= kCells; across += size) {
        for (int along = 0; along < kCells; along += size) {
          const Corner from{along_x ? along : across, along_x ? across : along};
          const Corner middle{from.i + (along_x ? half : 0), from.j + (along_x ? 0 : half)};
          if (needs(middle.i, middle.j)) continue;
          if (needs_below_edge(middle, half, along_x) ||
              (lattice && leaves_at_edge(*lattice, from, size, along_x, most_mm)))
            set(middle.i, middle.j);
        }
      }
    }
    for (int j = 0; j < kCells; j += size) {
      for (int i = 0; i < kCells; i += size) {
        if (needs(i + half, j + half)) continue;
        if (needs(i + half, j) || needs(i + half, j + size) || needs(i, j + half) ||
            needs(i + size, j + half) ||
            (lattice && leaves_in_square(*lattice, {i, j}, size, most_mm)))
          set(i + half, j + half);
      }
    }
  }
}

namespace {

TileNetwork::Corner on_rim(TileNetwork::Side side, int k) {
  switch (side) {
    case TileNetwork::Side::kLeft:
      return {0, k};
    case TileNetwork::Side::kRight:
      return {kCells, k};
    case TileNetwork::Side::kLow:
      return {k, 0};
    case TileNetwork::Side::kHigh:
      break;
  }
  return {k, kCells};
}

}  // namespace

std::uint64_t TileNetwork::rim(Side side) const {
  std::uint64_t corners = 0;
  for (int k = 1; k < kCells; ++k) {
    const Corner at = on_rim(side, k);
    corners |= std::uint64_t{needs(at.i, at.j)} << k;
  }
  return corners;
}

bool TileNetwork::add_rim(Side side, std::uint64_t corners) {
  const std::uint64_t more = corners & ~rim(side);
  if (more == 0) return false;
  for (int k = 1; k < kCells; ++k) {
    const Corner at = on_rim(side, k);
    if (more >> k & 1) set(at.i, at.j);
  }
  complete(nullptr, 0);
  return true;
}

}  // namespace kerf
