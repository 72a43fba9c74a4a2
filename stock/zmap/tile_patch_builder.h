// stock/zmap/tile_patch_builder.h - the triangles of a tile: what tile_patch.h says of them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <limits>
#include <vector>

#include "base/mesh_patch.h"
#include "stock/zmap/tile_cut_ids.h"
#include "surface/tile_network.h"
#include "surface/tile_relief.h"

namespace kerf {

/// On which sides the tile has neighbours, and how far skirts go down there.
struct PatchSide {
  bool has_neighbor = false;
  glm::vec2 outward{0};
  float skirt_end_mm = 0;
};
struct PatchSides {
  PatchSide left, right, low, high;
};

/// A whole tile that has material all over and no moved corners below has a floor of few triangles,
/// fewer still if on these sides it goes on in such a tile.
struct PlainFloor {
  bool is_plain = false;
  bool left = false, right = false, low = false, high = false;
};

class TilePatchBuilder {
 public:
  /// `cut_ids` is null where they are not kept.
  TilePatchBuilder(const TileRelief& relief, const TileCutIds* cut_ids, const PatchSides& sides,
                   MeshPatch& patch)
      : r_(relief), cut_ids_(cut_ids), sides_(sides), patch_(patch) {
    top_.fill(kNone);
    bottom_.fill(kNone);
    const std::size_t corners =
        static_cast<std::size_t>(r_.nx() + 1) * static_cast<std::size_t>(r_.ny() + 1);
    patch_.vertices.reserve(corners + corners / 4);
    patch_.indices.reserve(7 * corners);
    if (cut_ids_) patch_.cut_by.reserve(corners + corners / 4);
  }

  void add_surface();
  /// The same surface with the triangles of a network, which must keep the cells that have a split
  /// corner.
  void add_sparse_surface(const TileNetwork& network, const PlainFloor& floor);
  void add_skirts();

 private:
  /// Quadrants of a corner, as TileRelief counts them.
  enum Quadrant : std::size_t { kA, kB, kC, kD };
  /// Squares of fewer cells are not looked at for being level.
  static constexpr int kLeastSquare = 8;
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  /// Added to the number of a split corner where otherwise the number of a vertex is.
  static constexpr std::uint32_t kSplitCorner = std::uint32_t{1} << 31;
  /// Cracks between tiles of different levels are about as deep as the surface is steep.
  static constexpr float kCrack_cells = 4;

  struct SplitCorner {
    TileRelief::Split split;
    glm::vec2 xy_mm;  ///< where the wall has its course
    std::array<std::uint32_t, 4> vertex{kNone, kNone, kNone, kNone};  ///< by group
  };
  using Ring = std::array<std::uint32_t, 4 * kTileCells>;

  std::uint32_t add_vertex(const glm::vec2& xy, float z, std::uint32_t normal) {
    patch_.vertices.push_back({{xy, z}, normal});
    return static_cast<std::uint32_t>(patch_.vertices.size() - 1);
  }
  glm::vec2 unmoved(int i, int j) const { return {r_.x(i), r_.y(j)}; }
  /// Of all that stands above each other at a corner.
  glm::vec2 place_of(int i, int j) {
    return r_.is_split(TileRelief::slot(i, j)) ? split_corner(i, j).xy_mm : unmoved(i, j);
  }
  /// Much cheaper than vector::insert() for so few.
  template <std::size_t kCount>
  void append_indices(const std::array<std::uint32_t, kCount>& indices) {
    const std::size_t size = patch_.indices.size();
    patch_.indices.resize(size + kCount);
    std::copy(indices.begin(), indices.end(), patch_.indices.data() + size);
  }
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    append_indices<3>({a, b, c});
  }

  std::uint32_t cut_by(int cell) const {
    return cut_ids_ ? cut_ids_->of(cell) : MeshPatch::kNotCut;
  }
  void set_cut_by(std::uint32_t vertex, std::uint32_t id);
  void set_cut_by_of_corners();

  SplitCorner& split_corner(int i, int j);
  float z_at(int i, int j, Quadrant q);
  std::uint32_t top_vertex(int i, int j, Quadrant q) {
    const int corner = TileRelief::slot(i, j);
    std::uint32_t& vertex = top_[static_cast<std::size_t>(corner)];
    if (vertex < kSplitCorner) return vertex;
    if (r_.is_split(corner)) [[unlikely]]
      return split_vertex(i, j, q);
    return vertex = add_vertex(unmoved(i, j), r_.corner_z(corner), r_.corner_normal(corner));
  }
  [[gnu::noinline]] std::uint32_t split_vertex(int i, int j, Quadrant q);
  /// Vertices of a cell, counter-clockwise from low x, y.
  std::array<std::uint32_t, 4> cell_corners(int i, int j) {
    const std::uint32_t* const row = top_.data() + TileRelief::slot(i, j);
    const std::array<std::uint32_t, 4> known{row[0], row[1], row[TileRelief::kStride + 1],
                                             row[TileRelief::kStride]};
    if ((known[0] | known[1] | known[2] | known[3]) < kSplitCorner) [[likely]]
      return known;
    return {top_vertex(i, j, kC), top_vertex(i + 1, j, kD), top_vertex(i + 1, j + 1, kA),
            top_vertex(i, j + 1, kB)};
  }
  std::uint32_t bottom_vertex(int i, int j);

  bool is_level(int i, int j, int size) const;
  /// A corner of the cell's.
  bool may_be_moved(int cell) const {
    const std::uint32_t* const row = top_.data() + cell;
    return (row[0] | row[1] | row[TileRelief::kStride] | row[TileRelief::kStride + 1]) >=
           kSplitCorner;
  }
  bool is_rising(int i, int j, const std::array<std::uint32_t, 4>& corners, float height) const;
  template <class Corner>
  void add_fan(int i, int j, int width, int height, std::uint32_t center, bool upward,
               const Corner& corner);
  void add_square(int i, int j, int size);
  void add_cells(int first_i, int first_j, int last_i, int last_j);
  bool is_seen_from(std::uint32_t center);
  void add_floor();
  bool add_plain_floor(const PlainFloor& floor);
  void end_surface();

  struct WallEnd;
  void add_walls();
  void add_wall(int cell, bool along_y, int i, int j, bool owned_if_lower, bool owned_if_higher);
  WallEnd wall_end(int i, int j, Quadrant upper, Quadrant lower);
  /// A corner on the tile's border, and the quadrants of the cells within and beyond it.
  struct BorderEnd {
    int i, j;
    Quadrant inner, outer;
  };
  void add_skirt(const PatchSide& side, int outer_cell, bool is_linked, const BorderEnd& from,
                 const BorderEnd& to);

  const TileRelief& r_;
  const TileCutIds* cut_ids_;
  PatchSides sides_;
  MeshPatch& patch_;
  std::array<std::uint32_t, TileRelief::kSlots> top_;  ///< or kSplitCorner + which
  std::array<std::uint32_t, TileRelief::kSlots> bottom_;
  std::vector<SplitCorner> splits_;
};

}  // namespace kerf
