#include <glm/geometric.hpp>
#include <optional>

#include "stock/zmap/tile_patch_builder.h"

namespace kerf {

/// One vertical edge of a wall: heights from that of the first cell to that of the second; between
/// them those of the other cells at this corner, since walls between those end there.
struct TilePatchBuilder::WallEnd {
  int i, j;
  std::array<float, 4> z;
  std::size_t count = 0;
  std::array<std::uint32_t, 4> vertex;
};

TilePatchBuilder::WallEnd TilePatchBuilder::wall_end(int i, int j, Quadrant first,
                                                     Quadrant second) {
  WallEnd end{i, j, {}, 0, {}};
  const int corner = TileRelief::slot(i, j);
  end.z[end.count++] = z_at(i, j, first);
  if (!r_.is_split(corner)) return end;
  const std::array<float, 4> all = split_corner(i, j).split.z;
  const float last = all[second];
  const bool down = last < end.z[0];
  for (;;) {
    std::optional<float> next;  // the nearest that lies beyond the present one
    for (const float z : all) {
      const float at = end.z[end.count - 1];
      const bool between = down ? z < at && z >= last : z > at && z <= last;
      if (between && (!next || (down ? z > *next : z < *next))) next = z;
    }
    if (!next) return end;
    end.z[end.count++] = *next;
  }
}

/// The wall between `cell` and the one before it in x (along_y) or in y, if this tile has it.
void TilePatchBuilder::add_wall(int cell, bool along_y, int i, int j, bool owned_if_lower,
                                bool owned_if_higher) {
  const int before = along_y ? cell - 1 : cell - TileRelief::kStride;
  if (along_y ? r_.linked_x(before) : r_.linked_y(before)) return;
  // Seen along the edge, the first cell is at the left: walls along x are turned by a quarter.
  WallEnd low = along_y ? wall_end(i, j, kD, kC) : wall_end(i + 1, j, kA, kD);
  WallEnd high = along_y ? wall_end(i, j + 1, kA, kB) : wall_end(i, j, kB, kC);
  if (low.count + high.count == 2) return;
  const float first = low.z[0] + high.z[0];
  const float second = low.z[low.count - 1] + high.z[high.count - 1];
  const bool first_is_higher = first >= second;
  if (first_is_higher ? !owned_if_lower : !owned_if_higher) return;

  // Made by what lowered the lower side; a side of the blank by nothing.
  const std::uint32_t made_by = cut_by(r_.height(cell) < r_.height(before) ? cell : before);
  const glm::vec2 axis(along_y ? 1 : 0, along_y ? 0 : 1);
  const glm::vec2 outward = first_is_higher ? axis : -axis;
  // A side of the blank is flat to its very end.
  const bool side =
      along_y
          ? (i == 0 && !sides_.left.has_neighbor) || (i == r_.nx() && !sides_.right.has_neighbor)
          : (j == 0 && !sides_.low.has_neighbor) || (j == r_.ny() && !sides_.high.has_neighbor);
  std::array<glm::vec2, 2> facing{outward, outward};
  if (!side) {
    const WallCourse course = r_.wall_course(i, j, along_y);
    facing = {course.facing(false, outward), course.facing(true, outward)};
  }
  for (WallEnd* end : {&low, &high}) {
    const glm::vec2 xy = place_of(end->i, end->j);
    const bool is_higher = along_y ? end->j > j : end->i > i;
    const std::uint32_t normal = pack_normal(glm::vec3(facing[is_higher], 0));
    for (std::size_t n = 0; n < end->count; ++n) {
      end->vertex[n] = add_vertex(xy, end->z[n], normal);
      set_cut_by(end->vertex[n], made_by);
    }
  }
  // A zip from the first cell's edge to the second's.
  std::size_t p = 0, q = 0;
  while (p + 1 < low.count || q + 1 < high.count) {
    if (q + 1 == high.count || (p + 1 < low.count && p <= q)) {
      add_triangle(low.vertex[p + 1], high.vertex[q], low.vertex[p]);
      ++p;
    } else {
      add_triangle(high.vertex[q + 1], high.vertex[q], low.vertex[p]);
      ++q;
    }
  }
}

void TilePatchBuilder::add_walls() {
  // Most rows have no wall, which a look at all their links together tells.
  for (int j = 0; j < r_.ny(); ++j) {
    if (r_.all_linked_x(TileRelief::slot(-1, j), r_.nx() + 1)) continue;
    for (int i = 0; i <= r_.nx(); ++i)
      add_wall(TileRelief::slot(i, j), true, i, j, i > 0, i < r_.nx());
  }
  for (int j = 0; j <= r_.ny(); ++j) {
    if (r_.all_linked_y(TileRelief::slot(0, j - 1), r_.nx())) continue;
    for (int i = 0; i < r_.nx(); ++i)
      add_wall(TileRelief::slot(i, j), false, i, j, j > 0, j < r_.ny());
  }
}

/// Below the edge of a cell's top from `from` to `to`, which runs with the outside on its right; or
/// below the wall of this tile that is there. It ends on the tile's border, wherever the top's
/// corners were moved, so that no gap is left between tiles seen from above. None where the surface
/// is level all about.
void TilePatchBuilder::add_skirt(const PatchSide& side, int outer_cell, bool is_linked,
                                 const BorderEnd& from, const BorderEnd& to) {
  const auto z = [&](const BorderEnd& end, Quadrant q) { return z_at(end.i, end.j, q); };
  const bool is_below_wall =
      !is_linked && z(from, from.inner) + z(to, to.inner) >= z(from, from.outer) + z(to, to.outer);
  const auto upper_z = [&](const BorderEnd& end) {
    return z(end, is_below_wall ? end.outer : end.inner);
  };
  if (upper_z(from) <= side.skirt_end_mm && upper_z(to) <= side.skirt_end_mm) return;
  const std::uint32_t level = pack_normal(glm::vec3(side.outward, 0));
  const auto add = [&](const glm::vec2& xy, float height, std::uint32_t normal, std::uint32_t id) {
    const std::uint32_t vertex = add_vertex(xy, height, normal);
    set_cut_by(vertex, id);
    return vertex;
  };
  struct Ends {
    std::uint32_t upper, lower;
  };
  const auto ends = [&](const BorderEnd& end) -> Ends {
    const glm::vec2 border = unmoved(end.i, end.j);
    if (is_below_wall) {
      const std::uint32_t id = cut_by(outer_cell);
      return {add(place_of(end.i, end.j), upper_z(end), level, id),
              add(border, side.skirt_end_mm, level, id)};
    }
    const std::uint32_t top = top_vertex(end.i, end.j, end.inner);
    // Where a skirt fills a crack it must not be seen: the top's own normals. Where it is high, it
    // may stand between walls that coarse cells have elsewhere than fine ones, and is lit as a
    // wall.
    const bool is_high = upper_z(end) - side.skirt_end_mm > kCrack_cells * r_.cell_mm();
    const std::uint32_t normal = is_high ? level : patch_.vertices[top].normal;
    const std::uint32_t id = cut_ids_ ? patch_.cut_by[top] : MeshPatch::kNotCut;
    return {top, add(border, side.skirt_end_mm, normal, id)};
  };
  const Ends a = ends(from), b = ends(to);
  add_triangle(a.lower, b.lower, b.upper);
  add_triangle(a.lower, b.upper, a.upper);
}

void TilePatchBuilder::add_skirts() {
  const int nx = r_.nx(), ny = r_.ny();
  const auto slot = [](int i, int j) { return TileRelief::slot(i, j); };
  for (int j = 0; j < ny; ++j) {
    if (sides_.left.has_neighbor && r_.solid(slot(0, j)))
      add_skirt(sides_.left, slot(-1, j), r_.linked_x(slot(-1, j)), {0, j + 1, kB, kA},
                {0, j, kC, kD});
    if (sides_.right.has_neighbor && r_.solid(slot(nx - 1, j)))
      add_skirt(sides_.right, slot(nx, j), r_.linked_x(slot(nx - 1, j)), {nx, j, kD, kC},
                {nx, j + 1, kA, kB});
  }
  for (int i = 0; i < nx; ++i) {
    if (sides_.low.has_neighbor && r_.solid(slot(i, 0)))
      add_skirt(sides_.low, slot(i, -1), r_.linked_y(slot(i, -1)), {i, 0, kC, kB},
                {i + 1, 0, kD, kA});
    if (sides_.high.has_neighbor && r_.solid(slot(i, ny - 1)))
      add_skirt(sides_.high, slot(i, ny), r_.linked_y(slot(i, ny - 1)), {i + 1, ny, kA, kD},
                {i, ny, kB, kC});
  }
}

}  // namespace kerf
