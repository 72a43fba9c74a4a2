// stock/zmap/mmap/column_relief.h - one tile of columns and its surroundings as a patch is made
// from them: their faces, and which of them belong to one smooth surface.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "base/mesh_patch.h"
#include "stock/zmap/mmap/gap_grid.h"
#include "stock/zmap/tile_cut_ids.h"
#include "surface/tile_relief.h"
#include "surface/wall_course.h"

namespace kerf {

/// Cells are named by TileRelief::slot(). The faces of a cell are the upper and lower ends of its
/// material, from the top downward: up, down, up, down. A cell without material has none.
///
/// Faces of neighbouring cells are linked one to one where the surface between them is smooth: tops
/// as in TileRelief; others that are nearest to each other, face the same way, and differ by no
/// more than a smooth surface does (SurfaceSlopes). Links do not cross: of two faces of a cell the
/// upper one is linked to the upper one.
///
/// The four cells about a corner have it at their corner 2, 3, 0 and 1: counted from low x, y
/// around a cell. Faces that hang together by links about a corner meet there at one height.
class ColumnRelief {
 public:
  struct Face {
    float z = 0;
    bool up = false;
    bool is_top = false;     ///< the one that TileRelief has
    bool is_ground = false;  ///< on the floor of the workpiece
    std::uint32_t cut_by = MeshPatch::kNotCut;
  };
  using FaceIndex = std::int32_t;
  static constexpr FaceIndex kNone = -1;

  /// Level as in make_column_patch(). O(cells).
  ColumnRelief(const TileGrid& grid, const GapGrid& gaps, std::uint32_t tile, int level);
  ColumnRelief(const ColumnRelief&) = delete;
  ColumnRelief& operator=(const ColumnRelief&) = delete;

  const TileRelief& tops() const { return relief_; }
  int nx() const { return relief_.nx(); }
  int ny() const { return relief_.ny(); }
  bool keeps_cut_ids() const { return cut_ids_.has_value(); }

  FaceIndex first_face(int cell) const { return first_[at(cell)]; }
  FaceIndex end_face(int cell) const { return first_[at(cell) + 1]; }
  std::size_t face_count() const { return faces_.size(); }
  const Face& face(FaceIndex f) const { return faces_[at(f)]; }
  /// The face of the next cell in x (in y) that this one is linked to, or kNone; and of the one
  /// before.
  FaceIndex next(FaceIndex f, bool in_y) const { return links_[in_y ? 1 : 0].next[at(f)]; }
  FaceIndex before(FaceIndex f, bool in_y) const { return links_[in_y ? 1 : 0].before[at(f)]; }
  /// Of the surface: dz/dx, dz/dy.
  glm::vec2 slope(FaceIndex f) const;

  /// Is there material at this height? (i, j) as cells are counted in the tile, within
  /// TileRelief::wall_reach() of it.
  bool is_solid(int i, int j, float z) const;
  bool is_in_grid(int i, int j) const {
    return i >= grid_begin_.x && j >= grid_begin_.y && i < grid_end_.x && j < grid_end_.y;
  }
  /// The move that took the material of a cell away at this height and below, as far as is known.
  std::uint32_t cut_by_below(int i, int j, float z) const;
  int level() const { return level_; }

 private:
  struct Links {
    std::vector<FaceIndex> next, before;
  };
  static std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }
  void load(const TileGrid& grid, const GapGrid& gaps, int i, int j);
  void load_column(float height, std::uint32_t top_cut_by);
  void link(int cell, bool in_y);
  FaceIndex nearest(int cell, bool up, float z) const;
  bool is_smooth(int cell, bool in_y, FaceIndex a, FaceIndex b) const;

  int level_, reach_;
  TileRelief relief_;
  std::optional<TileCutIds> cut_ids_;
  glm::ivec2 tile_begin_, grid_begin_, grid_end_;
  float cell_x_, cell_y_;
  std::array<FaceIndex, TileRelief::kSlots + 1> first_;
  std::vector<Face> faces_;
  std::array<Links, 2> links_;
  std::vector<Gap> column_, merged_;  ///< working memory
};

}  // namespace kerf
