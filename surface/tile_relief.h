// surface/tile_relief.h - one tile of a grid of heights and its surroundings as a surface is made
// from them: heights of cells, which of them belong to one smooth surface, and where that surface
// has its corners. Patches of triangles (stock/zmap) and what rays hit (surface_tile.h) are this
// one.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>

#include "base/geometry.h"
#include "surface/height_grid.h"
#include "surface/wall_course.h"
#include "surface/wall_shift.h"

namespace kerf {

/// A tile of a grid with the tiles about it. Cells of a tile lie as in a HeightGrid; those beyond
/// the grid are not read.
struct TilesAbout {
  template <class Grid>
  TilesAbout(const Grid& grid, int x, int y)
      : bounds_mm(grid.bounds_mm()),
        cells(grid.nx(), grid.ny()),
        cell_x_mm(grid.cell_x_mm()),
        cell_y_mm(grid.cell_y_mm()),
        floor_mm(grid.floor_mm()),
        at(x, y) {
    for (int ty = std::max(0, y - 1); ty <= std::min(y + 1, grid.tiles_y() - 1); ++ty)
      for (int tx = std::max(0, x - 1); tx <= std::min(x + 1, grid.tiles_x() - 1); ++tx)
        tiles[static_cast<std::size_t>((ty - y + 1) * 3 + tx - x + 1)] = grid.tile(tx, ty);
  }
  const float* tile(int tx, int ty) const {
    return tiles[static_cast<std::size_t>((ty - at.y + 1) * 3 + tx - at.x + 1)];
  }

  Box bounds_mm;  ///< of the grid, as all but `at` and `tiles`
  glm::ivec2 cells;
  double cell_x_mm, cell_y_mm;
  float floor_mm;
  glm::ivec2 at;
  std::array<const float*, 9> tiles{};  ///< row by row from low x, y; null beyond the grid
};

/// The lines x, y of the corners of cells divide the tile; a corner is named as the cell to its
/// upper right. A "slot" is an index into all arrays here.
///
///      D | C        A..D: the four cells about a corner; `quadrant` 0..3 counts them in this
///     ---+---       order. Corner (i, j) has cell (i, j) for its C.
///      A | B
///
/// Two neighbouring cells are linked if the surface between them is smooth, which
/// SurfaceSlopes::is_smooth() tells; else there is a wall. So flanks of a ball or a chamfer are
/// smooth, however steep, a step in a level floor is a step, and a slot one cell wide keeps its
/// bottom. A cell with material and one without are never linked.
/// At a corner those of the four cells that hang together by links meet in the mean of their
/// heights. With three links or four that is all of them; else the corner is split.
class TileRelief {
 public:
  static constexpr float kSmoothSlope = SurfaceSlopes::kSmooth;
  static constexpr float kSteepestSlope = SurfaceSlopes::kSteepest;
  /// Cells beyond the tile. A corner depends on three, the course of a wall on wall_reach(), and so
  /// does the normal of what is steeper than kSteepestSlope: it faces as a wall there would
  /// (slope_across_course()).
  static constexpr int kHalo = WallCourse::kMaxReach;
  static constexpr int kCornerReach = 4;
  static constexpr int kTileCells = HeightGrid::kTileCells;
  static constexpr int kStride = kTileCells + 2 * kHalo;
  static constexpr int kSlots = kStride * kStride;

  /// A corner of which not all four cells hang together.
  struct Split {
    std::array<float, 4> z;             ///< by quadrant
    std::array<glm::vec2, 4> slope;     ///< dz/dx, dz/dy
    std::array<std::uint8_t, 4> group;  ///< first quadrant that hangs together with this one
  };

  /// Level n: a cell is 2^n x 2^n cells of the grid, or what of them lies in it, at the least of
  /// their heights; kCornerReach of them are a tile at most. Tiles are counted row by row.
  /// O(cells): 20 to 40 us.
  template <class Grid>
  TileRelief(const Grid& grid, std::size_t tile, int level)
      : TileRelief(TilesAbout(grid, static_cast<int>(tile) % grid.tiles_x(),
                              static_cast<int>(tile) / grid.tiles_x()),
                   level) {
    find_surface();
  }
  /// Heights alone, until find_surface() is called.
  TileRelief(const TilesAbout& about, int level);
  void find_surface();
  TileRelief(const TileRelief&) = delete;
  TileRelief& operator=(const TileRelief&) = delete;

  int nx() const { return nx_; }  ///< cells of the tile
  int ny() const { return ny_; }
  float floor() const { return floor_; }
  /// By quadrant.
  static std::array<int, 4> cells_about(int corner) {
    return {corner - kStride - 1, corner - kStride, corner, corner - 1};
  }
  static int slot(int i, int j) { return (j + kHalo) * kStride + i + kHalo; }

  float height(int cell) const { return height_[index(cell)]; }
  bool solid(int cell) const { return height(cell) > floor_; }
  /// A whole tile of which every cell has the same height, and so has each that its corners depend
  /// on.
  bool is_level() const;
  bool linked_x(int cell) const { return link_x_[index(cell)] > 0.5f; }  ///< with the next in x
  bool linked_y(int cell) const { return link_y_[index(cell)] > 0.5f; }
  /// `count` cells from `cell` on in x.
  bool all_linked_x(int cell, int count) const { return all_set(link_x_, cell, count); }
  bool all_linked_y(int cell, int count) const { return all_set(link_y_, cell, count); }
  float x(int i) const { return x_[index(i)]; }  ///< of corner line i, mm
  float y(int j) const { return y_[index(j)]; }
  /// The longer edge of a whole cell.
  float cell_mm() const { return std::max(cell_mm_.x, cell_mm_.y); }
  /// Edges of a cell. The last ones of the grid may be narrower than the others.
  glm::vec2 size_mm(int i, int j) const { return {x(i + 1) - x(i), y(j + 1) - y(j)}; }

  bool is_split(int corner) const { return link_count_[index(corner)] < 2.5f; }
  /// Where is_split() is false: the one height and packed normal of the corner.
  float corner_z(int corner) const { return corner_z_[index(corner)]; }
  std::uint32_t corner_normal(int corner) const { return corner_normal_[index(corner)]; }
  Split split(int corner) const;
  /// Of a split corner what one cell has of it.
  struct Meeting {
    float z;
    glm::vec2 slope;
  };
  Meeting meeting(int corner, std::size_t quadrant) const;
  /// Where is_split(): how far to move the corner to the wall's course, in cells or mm. Elsewhere
  /// corners stay.
  glm::vec2 shift(int i, int j) const;
  glm::vec2 shift_mm(int i, int j) const { return to_mm(shift(i, j), i, j); }
  /// A shift in cells; less beside a narrow cell.
  glm::vec2 to_mm(const glm::vec2& shift, int i, int j) const {
    const glm::vec2 share(i + 1 == grid_end_.x ? last_share_.x : 1,
                          j + 1 == grid_end_.y ? last_share_.y : 1);
    return shift * share * cell_mm_;
  }
  /// Course of the wall between a cell and the one before it in x, or in y. With it a round or
  /// oblique wall is lit as it is, not as its cells are.
  WallCourse wall_course(int i, int j, bool across_x) const;
  /// Cells beyond the tile that are looked at. Less at coarse levels, so that the next tiles are
  /// enough.
  static int wall_reach(int level) {
    return std::clamp(kTileCells / 2 >> level, kCornerReach, WallCourse::kMaxReach);
  }

 private:
  template <class T>
  using Field = std::array<T, kSlots>;
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  static bool all_set(const Field<float>& links, int first, int count) {
    const float* const link = links.data() + first;
    int set = 0;  // without a way out of the loop, so that several are looked at at a time
    for (int k = 0; k < count; ++k) set += link[k] > 0.5f;
    return set == count;
  }
  void load_cells(const TilesAbout& about);
  void load_blocks(const TilesAbout& about, int level);
  void find_links(float cell_x, float cell_y);
  void find_corners(float cell_x, float cell_y);
  void turn_steep_normals();
  /// The slope at a corner, of cells that hang together there.
  glm::vec2 turned_if_steep(int corner, const glm::vec2& slope) const;

  /// Along the way round: A-B, B-C, C-D, D-A.
  std::array<bool, 4> links_about(const std::array<int, 4>& cells) const {
    return {linked_x(cells[0]), linked_y(cells[1]), linked_x(cells[3]), linked_y(cells[0])};
  }
  /// The quadrants, as bits, that hang together with this one.
  static unsigned group_of(const std::array<bool, 4>& links, std::size_t quadrant);
  Meeting meeting_of(int corner, unsigned group) const;
  /// Calls `with(height, inside)` as WallCourse and wall_shift() take them.
  template <class With>
  auto with_surroundings(const With& with) const;

  int nx_ = 0, ny_ = 0;
  int wall_reach_;
  glm::ivec2 grid_begin_, grid_end_;  ///< of the grid, as cells are counted here
  float floor_ = 0;
  glm::vec2 cell_mm_;        ///< edges of a whole cell
  glm::vec2 last_share_{1};  ///< what of it the last cells of the grid have
  std::array<float, kTileCells + 1> x_, y_;
  alignas(64) Field<float> height_;
  alignas(64) Field<float> step_x_, step_y_;    ///< to the next cell; 0 where one has no material
  alignas(64) Field<float> link_x_, link_y_;    ///< 1 or 0
  alignas(64) Field<float> slope_x_, slope_y_;  ///< of the surface over a cell
  alignas(64) Field<float> link_count_, corner_z_;
  alignas(64) Field<std::uint32_t> corner_normal_;
};

}  // namespace kerf
